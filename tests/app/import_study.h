// A study made by the program itself, with one consenting subject and an open session, and short ways to use it.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_data.h"

namespace striae::testing {

class ProgramStudy : public ::testing::Test {
 protected:
  void SetUp() override {
    Must({"init", study_, "--protocol", "IMP-1", "--title", "Import", "--sponsor", "Example Institute", "--site", "A"});
    Do({"subject", "add", "S001"});
    Do({"consent", "S001", "--given", "2026-05-01"});
    session_ = Do({"session", "open", "--subject", "S001", "--visit", "V1"}).at("id");
  }

  [[nodiscard]] std::string Path(const std::string& name) const { return (dir_ / name).string(); }
  static nlohmann::json Must(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, 0) << words.front() << ": " << ran.err;
    return ran.Json();
  }
  [[nodiscard]] Ran Run(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    words.emplace_back("--json");
    return Striae(words);
  }
  nlohmann::json Do(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    return Must(std::move(words));
  }
  /// A whole photograph that is another one for every name.
  [[nodiscard]] std::vector<std::uint8_t> Photo(const std::string& name) const {
    PhotoOptions options;
    options.lens = name;
    return MakeJpeg(options);
  }
  std::string WritePhoto(const std::string& name) const {
    WriteBytes(dir_ / name, Photo(name));
    return Path(name);
  }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(dir_ / name) << text;
    return Path(name);
  }

  TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
  std::string session_;
};

}  // namespace striae::testing
