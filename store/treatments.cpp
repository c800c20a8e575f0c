// Treatments of a subject, with their dates.
#include "store/annotations.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/strike.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kTreatments =
    "SELECT id, subject_id, date, text, by, at, supersedes FROM treatment t WHERE in_error = 0 AND NOT EXISTS (SELECT "
    "1 FROM treatment newer WHERE newer.supersedes = t.id)";

Treatment ReadTreatment(const RowView& row) {
  Treatment t{row.Key<TreatmentId>(0), row.Key<SubjectId>(1), row.Day(2), row.Text(3), row.Text(4), row.Time(5), {}};
  if (!row.IsNull(6)) t.supersedes = row.Key<TreatmentId>(6);
  return t;
}

Treatment InForce(Database& database, const TreatmentId& id) {
  auto found = database.One(std::string(kTreatments) + " AND t.id = ?", ReadTreatment, id);
  if (!found) Refuse(ErrorCode::kNotFound, "no treatment " + id.ToString() + " in force; see 'striae treatment list'");
  return *std::move(found);
}

void Insert(Change& change, const Treatment& t, bool in_error, const std::string& reason, const Stamp& stamp) {
  change.Insert("treatment",
                {{"id", ToValue(t.id)},
                 {"subject_id", ToValue(t.subject)},
                 {"date", ToValue(t.date)},
                 {"text", ToValue(t.text)},
                 {"in_error", ToValue(in_error ? 1 : 0)},
                 {"by", ToValue(stamp.user)},
                 {"at", ToValue(stamp.now)},
                 {"supersedes", ToValue(t.supersedes)}},
                reason);
}

}  // namespace

Status AddTreatment(Record& record, const Treatment& treatment, const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireText(treatment.text, "a treatment");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    detail::GetSubject(database, treatment.subject);
    if (treatment.supersedes) {
      detail::RequireReason(reason, "a correction");
      if (InForce(database, *treatment.supersedes).subject != treatment.subject) {
        Refuse(ErrorCode::kRecordRefused,
               "the corrected treatment is another subject's; mark that one as entered in error and add it anew");
      }
    }
    Insert(change, treatment, false, reason, stamp);
    change.Commit();
  });
}

Status StrikeTreatment(Record& record, const TreatmentId& id, const TreatmentId& new_id, const std::string& reason,
                       const Stamp& stamp) {
  return detail::Strike(record, InForce, Insert, id, new_id, reason, stamp);
}

Result<std::vector<Treatment>> Treatments(Record& record, std::optional<SubjectId> subject) {
  return Guarded([&] {
    return Access::Of(record).database.Rows(
        std::string(kTreatments) + " AND (?1 IS NULL OR subject_id = ?1) ORDER BY date, at, id", ReadTreatment,
        subject);
  });
}

}  // namespace striae::store
