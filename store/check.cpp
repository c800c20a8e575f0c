// `check`: proof that nothing is missing or altered.
#include "store/check.h"

#include <charconv>

#include "store/detail/check.h"
#include "store/detail/impl.h"

namespace striae::store {

Result<CheckReport> Check(Record& record, const CheckOptions& options) {
  CheckReport report;
  detail::Findings findings(report);
  const auto run = [&](const char* where, auto&& part) {
    // A part that cannot be read at all is a finding as well, and the other parts still run.
    if (const auto done = detail::Guarded(part); !done) findings.Error(where, done.error().message);
  };
  Record::Impl& study = detail::Access::Of(record);
  run("study.db", [&] { detail::CheckDatabase(study.database, findings); });
  run("study.db", [&] { detail::CheckSchema(study.database, findings); });
  run("audit trail", [&] { detail::CheckChain(study.database, options, findings); });
  run("study.db", [&] { detail::CheckRowsAgainstTrail(study.database, options.progress, findings); });
  run("objects", [&] { detail::CheckObjects(study.database, study.objects, options.progress, findings); });
  run("identity.striae", [&] { detail::CheckIdentities(study.database, study.folder, findings); });
  run("study", [&] { detail::CheckLeftovers(study.folder, findings); });
  findings.Close();
  return report;
}

Result<CheckReport> Record::Check(std::optional<AuditHead> expected) {
  CheckOptions options;
  if (expected) options.expected.push_back(*expected);
  return store::Check(*this, options);
}

std::string ToText(const AuditHead& head) {
  std::string text = std::to_string(head.sequence) + ":" + head.hash.ToString();
  return head.origin.empty() ? text : text + " " + head.origin;
}

Result<AuditHead> ParseHead(std::string_view text) {
  AuditHead head;
  const auto space = text.find(' ');
  if (space != std::string_view::npos) {
    const auto origin = Uuid::Parse(text.substr(space + 1));
    if (!origin)
      return Fail(ErrorCode::kUsage, "the head of a trail is NUMBER:HASH, with a copy's id after it or none");
    head.origin = origin->ToString();
    text = text.substr(0, space);
  }
  const auto colon = text.find(':');
  const char* end = text.data() + std::min(colon, text.size());
  const auto number = std::from_chars(text.data(), end, head.sequence);
  const auto hash = Sha256::Parse(colon == std::string_view::npos ? "" : text.substr(colon + 1));
  if (number.ec != std::errc() || number.ptr != end || head.sequence < 1 || !hash) {
    return Fail(ErrorCode::kUsage, "the head of a trail is NUMBER:HASH as an earlier 'striae check' printed it");
  }
  head.hash = *hash;
  return head;
}

}  // namespace striae::store
