// `striae check`: proof that nothing in the study is missing or altered.
#include <charconv>

#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

std::string ToText(const store::AuditHead& head) { return std::to_string(head.sequence) + ":" + head.hash.ToString(); }

Result<std::optional<store::AuditHead>> ParseHead(const std::string& text) {
  if (text.empty()) return std::optional<store::AuditHead>();
  store::AuditHead head;
  const auto colon = text.find(':');
  const char* end = text.data() + std::min(colon, text.size());
  const auto number = std::from_chars(text.data(), end, head.sequence);
  const auto hash = Sha256::Parse(colon == std::string::npos ? "" : text.substr(colon + 1));
  if (number.ec != std::errc() || number.ptr != end || head.sequence < 1 || !hash) {
    return Fail(ErrorCode::kUsage, "--head is NUMBER:HASH as an earlier 'striae check' printed it");
  }
  head.hash = *hash;
  return std::optional(head);
}

Status Check(Context& run, const std::string& head_text) {
  const auto expected = ParseHead(head_text);
  if (!expected) return Fail(expected.error());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto report = record->Check(*expected);
  if (!report) return Fail(report.error());
  std::string text;
  std::size_t errors = 0;
  for (const store::Finding& finding : report->findings) {
    const bool error = finding.severity == store::Finding::Severity::kError;
    errors += error ? 1 : 0;
    text += (error ? "ERROR   " : "warning ") + finding.where + " " + finding.what + "\n";
  }
  text += std::to_string(report->audit_rows) + " audit rows, " + std::to_string(report->objects) + " objects; head " +
          ToText(report->head) + (errors == 0 ? "\npassed" : "\nFAILED");
  nlohmann::json document = store::ToJson(*report);
  document["head_text"] = ToText(report->head);
  run.Output(document, text);
  if (errors != 0) {
    return Fail(ErrorCode::kRecordDamaged, "the study does not pass: " + std::to_string(errors) +
                                               " errors, each named above; keep this copy as it is for the inquiry");
  }
  return {};
}

}  // namespace

void AddCommand_check(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "check", "Verify the audit trail, every row and every file of the study",
                 "striae -C trial check --head 42:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08");
  auto head = std::make_shared<std::string>();
  command->add_option("--head", *head,
                      "The head that an earlier check printed: shows that the trail was not cut since");
  OnRun(command, context, [head](Context& run) { return Check(run, *head); });
}

}  // namespace striae::app
