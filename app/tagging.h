// What the operator says about photographs before they enter a session: `import` and `capture` ask alike.
#pragma once

#include <optional>
#include <string>

#include "acquire/source.h"
#include "app/command.h"
#include "store/record.h"

namespace striae::app {

/// As typed.
struct TagOptions {
  std::string session, role = "unassigned", body_site, laterality, range;
};

/// --session, --as, --site, --laterality and --range.
void AddTagOptions(CLI::App& command, TagOptions& options);

struct Tagged {
  store::Record record;
  acquire::CaptureBinding binding;
  std::optional<RigRange> range;  ///< when the operator overrides the device's own
};

/// Opens the study and binds what comes to the session: kUsage for words that mean nothing (before the study is
/// opened), else as OpenStudy and BindTo.
Result<Tagged> Tag(const Context& context, const TagOptions& options);

}  // namespace striae::app
