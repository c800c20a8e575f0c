// Running other people's DICOM programs, and writing files for them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/files.h"

namespace striae::dicom::testing {

struct ToolResult {
  int exit_code = -1;
  std::string output;  ///< stdout and stderr together
};
/// Runs a program from PATH and waits for it.
ToolResult RunTool(const std::vector<std::string>& command);
bool HasTool(const std::string& name);

using striae::testing::ReadBytes;
using striae::testing::WriteBytes;

/// A storescp of DCMTK on a free port of this machine, stopped when it goes out of scope.
class StoreScp {
 public:
  /// `options` before the port; `folder` receives the objects.
  StoreScp(const std::filesystem::path& folder, const std::vector<std::string>& options);
  ~StoreScp();
  StoreScp(const StoreScp&) = delete;
  StoreScp& operator=(const StoreScp&) = delete;
  [[nodiscard]] int port() const { return port_; }
  /// False when it did not come up within five seconds.
  [[nodiscard]] bool running() const { return running_; }

 private:
  pid_t pid_ = -1;
  int port_ = 0;
  bool running_ = false;
};

/// A port of this machine on which nobody listens.
int FreePort();

}  // namespace striae::dicom::testing

#define STRIAE_NEED_TOOL(name)                                                                 \
  if (!::striae::dicom::testing::HasTool(name)) {                                              \
    GTEST_SKIP() << "no program " << (name) << " here; script/packages.txt names its package"; \
  }                                                                                            \
  static_assert(true)
