#include "store/visits.h"

#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using detail::RequireReason;

constexpr const char* kArms = "SELECT id, name, title FROM arm";
constexpr const char* kPlan = "SELECT id, name, arm_id, day, window_from, window_to FROM planned_visit_now";

Arm ReadArm(const RowView& row) { return {row.Key<ArmId>(0), row.Text(1), row.Text(2)}; }

PlannedVisit ReadPlanned(const RowView& row) {
  PlannedVisit visit{row.Key<PlannedVisitId>(0), row.Text(1), {}, 0, 0, 0};
  if (!row.IsNull(2)) visit.arm = row.Key<ArmId>(2);
  visit.day = static_cast<int>(row.Integer(3));
  visit.window_from = static_cast<int>(row.Integer(4));
  visit.window_to = static_cast<int>(row.Integer(5));
  return visit;
}

void RefuseBadPlan(const PlannedVisit& visit) {
  if (visit.name.empty() || visit.name.size() > 64) {
    Refuse(ErrorCode::kUsage, "a planned visit needs a name of 1 to 64 characters, such as V2");
  }
  constexpr int kMost = 36'500;  // a hundred years
  if (visit.window_from > 0 || visit.window_to < 0 || visit.window_from < -kMost || visit.window_to > kMost ||
      visit.day < -kMost || visit.day > kMost) {
    Refuse(ErrorCode::kUsage, "a window is days before and after the target, such as -3,+3");
  }
}

void InsertPlanned(Change& change, const PlannedVisit& visit, bool dropped,
                   const std::optional<PlannedVisitId>& supersedes, const std::string& reason) {
  change.Insert("planned_visit",
                {{"id", ToValue(visit.id)},
                 {"name", ToValue(visit.name)},
                 {"arm_id", ToValue(visit.arm)},
                 {"day", ToValue(visit.day)},
                 {"window_from", ToValue(visit.window_from)},
                 {"window_to", ToValue(visit.window_to)},
                 {"dropped", ToValue(dropped ? 1 : 0)},
                 {"supersedes", ToValue(supersedes)}},
                reason);
}

void RefuseTwice(Database& database, const PlannedVisit& visit, const std::optional<PlannedVisitId>& but) {
  for (const PlannedVisit& there : database.Rows(kPlan, ReadPlanned)) {
    const bool overlap = !there.arm || !visit.arm || there.arm == visit.arm;
    if (there.name == visit.name && overlap && there.id != but) {
      Refuse(ErrorCode::kRecordRefused,
             "visit " + visit.name + " is planned already; see 'striae visit plan list', or change it with a reason");
    }
  }
}

PlannedVisit GetPlanned(Database& database, const PlannedVisitId& id) {
  auto found = database.One(std::string(kPlan) + " WHERE id = ?", ReadPlanned, id);
  if (!found) Refuse(ErrorCode::kNotFound, "no such visit in the plan in force; see 'striae visit plan list'");
  return *std::move(found);
}

}  // namespace

Status AddArm(Record& record, const Arm& arm, const Stamp& stamp) {
  return Guarded([&] {
    if (arm.name.empty() || arm.name.size() > 64) Refuse(ErrorCode::kUsage, "an arm needs a name such as A");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    if (database.Count("SELECT count(*) FROM arm WHERE name = ?", arm.name) != 0) {
      Refuse(ErrorCode::kRecordRefused, "there is an arm " + arm.name + " already");
    }
    change.Insert("arm", {{"id", ToValue(arm.id)}, {"name", ToValue(arm.name)}, {"title", ToValue(arm.title)}});
    change.Commit();
  });
}

Result<std::vector<Arm>> Arms(Record& record) {
  return Guarded([&] { return Access::Of(record).database.Rows(std::string(kArms) + " ORDER BY name", ReadArm); });
}

Result<Arm> ArmByName(Record& record, std::string_view name) {
  return Guarded([&] {
    auto arm = Access::Of(record).database.One(std::string(kArms) + " WHERE name = ?", ReadArm, name);
    if (!arm) {
      Refuse(ErrorCode::kNotFound, "no arm '" + std::string(name.substr(0, 40)) +
                                       "' in this study; see 'striae arm "
                                       "list', or add it with 'striae arm add'");
    }
    return *std::move(arm);
  });
}

Status AssignArm(Record& record, const SubjectId& subject, const ArmId& arm, const Date& date,
                 const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    detail::GetSubject(database, subject);
    const auto before = detail::Unwrap(ArmOf(record, subject));
    if (before && before->id == arm) return;
    if (before) RequireReason(reason, "the subject is in arm " + before->name + " already; a change");
    const auto number = detail::NextNumber(database, "arm_assignment", "subject_id", subject.ToString());
    const Uuid id = detail::UuidFrom({"arm", subject.ToString(), std::to_string(number), arm.ToString()});
    change.Insert("arm_assignment",
                  {{"id", ToValue(id.ToString())},
                   {"subject_id", ToValue(subject)},
                   {"arm_id", ToValue(arm)},
                   {"number", number},
                   {"date", ToValue(date)}},
                  reason);
    change.Commit();
  });
}

Result<std::optional<Arm>> ArmOf(Record& record, const SubjectId& subject) {
  return Guarded([&] {
    return Access::Of(record).database.One(std::string(kArms) +
                                               " WHERE id = (SELECT arm_id FROM arm_assignment WHERE subject_id = ? "
                                               "ORDER BY number DESC, id DESC LIMIT 1)",
                                           ReadArm, subject);
  });
}

Status PlanVisit(Record& record, const PlannedVisit& visit, const Stamp& stamp) {
  return Guarded([&] {
    RefuseBadPlan(visit);
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    RefuseTwice(database, visit, std::nullopt);
    InsertPlanned(change, visit, false, std::nullopt, "");
    change.Commit();
  });
}

Status ReplanVisit(Record& record, const PlannedVisitId& before, const PlannedVisit& visit, const std::string& reason,
                   const Stamp& stamp) {
  return Guarded([&] {
    RefuseBadPlan(visit);
    RequireReason(reason, "a change of the plan");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    GetPlanned(database, before);
    RefuseTwice(database, visit, before);
    InsertPlanned(change, visit, false, before, reason);
    change.Commit();
  });
}

Status DropVisit(Record& record, const PlannedVisitId& visit, const PlannedVisitId& new_id, const std::string& reason,
                 const Stamp& stamp) {
  return Guarded([&] {
    RequireReason(reason, "a change of the plan");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    PlannedVisit dropped = GetPlanned(database, visit);
    dropped.id = new_id;
    InsertPlanned(change, dropped, true, visit, reason);
    change.Commit();
  });
}

Result<std::vector<PlannedVisit>> VisitPlan(Record& record) {
  return Guarded(
      [&] { return Access::Of(record).database.Rows(std::string(kPlan) + " ORDER BY day, name, id", ReadPlanned); });
}

}  // namespace striae::store
