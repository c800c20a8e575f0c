// `check`: proof that nothing is missing or altered.
#include "store/detail/check.h"

#include "store/detail/impl.h"

namespace striae::store {

Result<CheckReport> Record::Check(std::optional<AuditHead> expected) {
  CheckReport report;
  const auto run = [&](const char* where, auto&& part) {
    // A part that cannot be read at all is a finding as well, and the other parts still run.
    if (const auto done = detail::Guarded(part); !done) {
      report.findings.push_back({Finding::Severity::kError, where, done.error().message});
    }
  };
  detail::Database& database = impl_->database;
  run("study.db", [&] { detail::CheckDatabase(database, report); });
  run("audit trail", [&] { detail::CheckChain(database, expected, report); });
  run("study.db", [&] { detail::CheckRowsAgainstTrail(database, report); });
  run("objects", [&] { detail::CheckObjects(database, impl_->objects, report); });
  return report;
}

}  // namespace striae::store
