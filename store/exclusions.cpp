// Captures and quantities that do not count, and why.
#include "store/annotations.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kExclusions = "SELECT id, capture_id, analysis, name, reason, by, at FROM exclusion_now";

struct Target {
  std::string capture;
  std::optional<std::string> analysis, name;
};

Target TargetOf(Database& database, const Record::Found& found) {
  if (found.entity == "capture") return {found.id, {}, {}};
  if (found.entity != "measurement") {
    Refuse(ErrorCode::kUsage, "a capture or a measurement is excluded, not a " + found.entity);
  }
  auto target = database.One(
      "SELECT o.capture_id, o.analysis, m.name FROM measurement m JOIN outcome o ON o.id = m.outcome_id WHERE m.id = ?",
      [](const RowView& row) {
        return Target{row.Text(0), row.Text(1), row.Text(2)};
      },
      found.id);
  if (!target) Refuse(ErrorCode::kNotFound, "no measurement " + found.id + " in this study; see 'striae results'");
  return *std::move(target);
}

Status Write(Record& record, const ExclusionId& id, const Record::Found& found, bool exclude, const std::string& reason,
             const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireReason(reason, exclude ? "an exclusion" : "taking back an exclusion");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    const Target target = TargetOf(database, found);
    const bool excluded =
        database.Count("SELECT count(*) FROM exclusion_now WHERE capture_id = ? AND analysis IS ? AND name IS ?",
                       target.capture, target.analysis, target.name) != 0;
    if (excluded == exclude) {
      Refuse(ErrorCode::kRecordRefused, exclude ? "it is excluded already" : "it is not excluded");
    }
    change.Insert("exclusion",
                  {{"id", ToValue(id)},
                   {"capture_id", ToValue(target.capture)},
                   {"analysis", ToValue(target.analysis)},
                   {"name", ToValue(target.name)},
                   {"number", detail::NextNumber(database, "exclusion", "capture_id", target.capture)},
                   {"excluded", ToValue(exclude ? 1 : 0)},
                   {"reason", ToValue(reason)},
                   {"by", ToValue(stamp.user)},
                   {"at", ToValue(stamp.now)}},
                  reason);
    change.Commit();
  });
}

}  // namespace

Status Exclude(Record& record, const ExclusionId& id, const Record::Found& target, const std::string& reason,
               const Stamp& stamp) {
  return Write(record, id, target, true, reason, stamp);
}

Status Include(Record& record, const ExclusionId& id, const Record::Found& target, const std::string& reason,
               const Stamp& stamp) {
  return Write(record, id, target, false, reason, stamp);
}

Result<std::vector<Exclusion>> Exclusions(Record& record, std::optional<CaptureId> capture) {
  return Guarded([&] {
    return Access::Of(record).database.Rows(
        std::string(kExclusions) + " WHERE ?1 IS NULL OR capture_id = ?1 ORDER BY at, id",
        [](const RowView& row) {
          return Exclusion{row.Key<ExclusionId>(0),
                           row.Key<CaptureId>(1),
                           row.OptionalText(2),
                           row.OptionalText(3),
                           row.Text(4),
                           row.Text(5),
                           row.Time(6)};
        },
        capture);
  });
}

}  // namespace striae::store
