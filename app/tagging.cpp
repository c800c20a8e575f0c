#include "app/tagging.h"

#include <utility>

#include "app/intake.h"
#include "app/names.h"
#include "app/study.h"

namespace striae::app {
namespace {

/// What was typed for an option cannot be meant: exit code 2.
tl::unexpected<Error> Usage(const Error& error, const char* option) {
  return Fail(ErrorCode::kUsage, std::string(option) + ": " + error.message);
}

}  // namespace

void AddTagOptions(CLI::App& command, TagOptions& options) {
  command
      .add_option("--session", options.session, "The session: its id (striae session list) or the code on its label")
      ->required();
  command.add_option("--as", options.role, "What they show: wound:LABEL, neutral, pose or unassigned")
      ->type_name("ROLE")
      ->capture_default_str();
  command.add_option("--site", options.body_site, "Part of the body, e.g. calf")->type_name("TEXT");
  command.add_option("--laterality", options.laterality, "L, R, B (both) or U (unpaired)")->type_name("SIDE");
  command
      .add_option("--range", options.range,
                  "Judge the settings for this rig, small (1 m) or large (2 m); otherwise the device's own")
      ->type_name("RANGE");
}

Result<Tagged> Tag(const Context& context, const TagOptions& options) {
  auto role = CaptureRole::Parse(options.role);
  if (!role) return Usage(role.error(), "--as");
  const auto laterality = ParseLaterality(options.laterality);
  if (!laterality) return Usage(laterality.error(), "--laterality");
  std::optional<RigRange> range;
  if (!options.range.empty()) {
    const auto parsed = ParseRigRange(options.range);
    if (!parsed) return Usage(parsed.error(), "--range");
    range = *parsed;
  }
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  const auto session = FindSession(*record, options.session);
  if (!session) return Fail(session.error());
  auto binding = BindTo(*record, session->id);
  if (!binding) return Fail(binding.error());
  binding->role = *std::move(role);
  binding->body_site = options.body_site;
  binding->laterality = *laterality;
  return Tagged{*std::move(record), *std::move(binding), range};
}

}  // namespace striae::app
