// Where subjects stand in the visit plan.
#include <algorithm>
#include <map>

#include "store/detail/read.h"
#include "store/detail/words.h"
#include "store/visits.h"

namespace striae::store {
namespace {

using State = VisitState::State;

/// Of one subject: the first day of each visit that was held, and the arm.
struct Course {
  std::map<std::string, Date> held;
  std::optional<ArmId> arm;
};

std::map<SubjectId, Course> Courses(Database& database) {
  std::map<SubjectId, Course> courses;
  // A session without its own day (study format 1) counts by its UTC day.
  database.Each(
      "SELECT e.subject_id, v.name, coalesce(e.day, substr(e.opened_at, 1, 10)) FROM session e JOIN visit v ON v.id = "
      "e.visit_id",
      [&](const RowView& row) {
        const Date day = row.Day(2);
        const auto [place, fresh] = courses[row.Key<SubjectId>(0)].held.try_emplace(row.Text(1), day);
        if (!fresh) place->second = std::min(place->second, day);
      });
  database.Each("SELECT subject_id, arm_id FROM arm_assignment ORDER BY number, id",
                [&](const RowView& row) { courses[row.Key<SubjectId>(0)].arm = row.Key<ArmId>(1); });
  return courses;
}

std::vector<PlannedVisit> PlanOf(const std::vector<PlannedVisit>& plan, const std::optional<ArmId>& arm) {
  std::vector<PlannedVisit> own;
  for (const PlannedVisit& visit : plan) {
    if (!visit.arm || visit.arm == arm) own.push_back(visit);
  }
  return own;
}

std::optional<Date> DayZero(const Subject& subject, const Course& course, const std::vector<PlannedVisit>& plan) {
  for (const PlannedVisit& visit : plan) {
    if (const auto held = course.held.find(visit.name); visit.day == 0 && held != course.held.end()) {
      return held->second;
    }
  }
  return subject.consent_given;
}

VisitState StateOf(const Subject& subject, const PlannedVisit& visit, const Course& course,
                   const std::optional<Date>& zero, const Date& today) {
  VisitState state{subject, visit, State::kWaiting, {}, {}, {}, {}};
  if (const auto held = course.held.find(visit.name); held != course.held.end()) state.held = held->second;
  if (zero) {
    state.target = DayAfter(*zero, visit.day);
    state.earliest = DayAfter(*state.target, visit.window_from);
    state.latest = DayAfter(*state.target, visit.window_to);
  }
  if (state.held) {
    const bool within = !zero || (*state.held >= *state.earliest && *state.held <= *state.latest);
    state.state = within ? State::kDone : State::kOutOfWindow;
  } else if (subject.consent_withdrawn) {
    state.state = State::kStopped;
  } else if (zero && today > *state.latest) {
    state.state = State::kLate;
  } else if (zero && today >= *state.earliest) {
    state.state = State::kDue;
  }
  return state;
}

}  // namespace

std::string_view ToString(State state) {
  switch (state) {
    case State::kWaiting:
      return "waiting";
    case State::kDue:
      return "due";
    case State::kLate:
      return "late";
    case State::kDone:
      return "done";
    case State::kOutOfWindow:
      return "out of window";
    case State::kStopped:
      return "stopped";
  }
  throw std::logic_error("VisitState");
}

Date DayAfter(const Date& date, std::int64_t days) {
  constexpr std::int64_t kMsPerDay = 86'400'000;
  return Date::Of(UtcTime{(date.DaysSinceEpoch() + days) * kMsPerDay});
}

Result<std::vector<VisitState>> VisitStates(Record& record, const Date& today, std::optional<SubjectId> only) {
  const auto plan = VisitPlan(record);
  if (!plan) return Fail(plan.error());
  const auto subjects = record.Subjects();
  if (!subjects) return Fail(subjects.error());
  return Guarded([&] {
    std::vector<VisitState> states;
    if (plan->empty()) return states;
    const auto courses = Courses(Access::Of(record).database);
    for (const Subject& subject : *subjects) {
      if (only && subject.id != *only) continue;
      const auto found = courses.find(subject.id);
      const Course course = found == courses.end() ? Course{} : found->second;
      const auto own = PlanOf(*plan, course.arm);
      const auto zero = DayZero(subject, course, own);
      for (const PlannedVisit& visit : own) states.push_back(StateOf(subject, visit, course, zero, today));
    }
    return states;
  });
}

Result<std::optional<VisitState>> PlanFor(Record& record, const SubjectId& subject, std::string_view visit,
                                          const Date& day) {
  const auto plan = VisitPlan(record);
  if (!plan) return Fail(plan.error());
  const auto person = record.SubjectById(subject);
  if (!person) return Fail(person.error());
  return Guarded([&]() -> std::optional<VisitState> {
    if (plan->empty()) return std::nullopt;
    auto courses = Courses(Access::Of(record).database);
    Course& course = courses[subject];
    const auto own = PlanOf(*plan, course.arm);
    std::string names;
    for (const PlannedVisit& planned : own) {
      names += " " + planned.name;
      if (planned.name != visit) continue;
      course.held.insert_or_assign(planned.name, day);
      return StateOf(*person, planned, course, DayZero(*person, course, own), day);
    }
    Refuse(ErrorCode::kRecordRefused, "visit " + std::string(visit.substr(0, 40)) + " is not in the plan of " +
                                          person->pseudonym + ", which has:" + names +
                                          "; correct the name, or say why it is held with --unscheduled REASON");
  });
}

}  // namespace striae::store
