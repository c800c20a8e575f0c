// Arms, the visit plan with its windows, and where each subject stands in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/study.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

using ArmId = Id<struct ArmTag>;
using PlannedVisitId = Id<struct PlannedVisitTag>;

struct Arm {
  ArmId id;
  std::string name;   ///< short: "A"
  std::string title;  ///< "standard care"
};

/// A visit that the protocol asks for. Days count from the subject's day 0 (see VisitState).
struct PlannedVisit {
  PlannedVisitId id;
  std::string name;          ///< "V2"
  std::optional<ArmId> arm;  ///< none: every arm
  int day = 0;               ///< target
  int window_from = 0;       ///< days before the target that still count, as a number <= 0
  int window_to = 0;         ///< days after it, >= 0
};

Status AddArm(Record& record, const Arm& arm, const Stamp& stamp);
Result<std::vector<Arm>> Arms(Record& record);
Result<Arm> ArmByName(Record& record, std::string_view name);
/// A second assignment needs a reason. The earlier one stays in the trail.
Status AssignArm(Record& record, const SubjectId& subject, const ArmId& arm, const Date& date,
                 const std::string& reason, const Stamp& stamp);
Result<std::optional<Arm>> ArmOf(Record& record, const SubjectId& subject);

/// kRecordRefused when a visit of that name is planned for that arm (or for all) already.
Status PlanVisit(Record& record, const PlannedVisit& visit, const Stamp& stamp);
/// `visit` (a new id) takes the place of `before`, which stays readable. Needs a reason.
Status ReplanVisit(Record& record, const PlannedVisitId& before, const PlannedVisit& visit, const std::string& reason,
                   const Stamp& stamp);
/// Takes a visit out of the plan with a reason.
Status DropVisit(Record& record, const PlannedVisitId& visit, const PlannedVisitId& new_id, const std::string& reason,
                 const Stamp& stamp);
/// In force, by day.
Result<std::vector<PlannedVisit>> VisitPlan(Record& record);

/// Where a subject stands with one planned visit on a day.
struct VisitState {
  enum class State {
    kWaiting,      ///< day 0 is not known yet, or the window has not begun
    kDue,          ///< the window is open
    kLate,         ///< the window is over and there was no session
    kDone,         ///< a session within the window
    kOutOfWindow,  ///< a session, but outside the window
    kStopped,      ///< not done, and consent was withdrawn
  };
  Subject subject;
  PlannedVisit visit;
  State state = State::kWaiting;
  std::optional<Date> earliest, target, latest;  ///< none while day 0 is not known
  std::optional<Date> held;                      ///< the day of the first session of that visit, at the site
};
std::string_view ToString(VisitState::State state);

/// Every subject's planned visits as of `today`, by pseudonym and day. Day 0 is the site's day of the first session of
/// the visit that is planned for day 0; until there is one, the day on which consent was given.
Result<std::vector<VisitState>> VisitStates(Record& record, const Date& today,
                                            std::optional<SubjectId> subject = std::nullopt);

/// What a session of that visit on that day would be, before it is opened. kRecordRefused when the study has a plan
/// that does not name the visit for this subject's arm.
Result<std::optional<VisitState>> PlanFor(Record& record, const SubjectId& subject, std::string_view visit,
                                          const Date& day);

/// A day as "2026-05-04", `days` later.
Date DayAfter(const Date& date, std::int64_t days);

}  // namespace striae::store
