// When a visit is due, late, done or out of its window.
#include "store/visits.h"

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::PlannedVisit;
using store::PlannedVisitId;
using State = store::VisitState::State;

PlannedVisit Plan(const std::string& name, int day, int from, int to, std::optional<store::ArmId> arm = {}) {
  return {CountedId<PlannedVisitId>(), name, arm, day, from, to};
}

Session OpenOn(SmallStudy& study, const Subject& subject, const std::string& visit, const Date& day) {
  Session session;
  session.id = CountedId<SessionId>();
  session.subject = subject.id;
  session.operator_name = "coordinator";
  session.opened_at = *UtcTime::Parse(day.ToString() + "T10:00:00.000Z");
  session.day = day;
  return *study->OpenSession(session, visit, CountedId<VisitId>(), NextStamp());
}

State StateOn(SmallStudy& study, const std::string& visit, const Date& today) {
  for (const auto& state : std::vector(*store::VisitStates(study.record(), today))) {
    if (state.visit.name == visit) return state.state;
  }
  ADD_FAILURE() << visit << " is not planned";
  return State::kWaiting;
}

TEST(VisitPlan, SaysOnEachDayWhereASubjectStands) {
  SmallStudy study;
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V2", 14, -3, 3), NextStamp()), IsOk());
  study.EnrolWithConsent("S001");  // consent on 2026-05-01: the target is the 15th, the window the 12th to the 18th
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 11}), State::kWaiting);
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 12}), State::kDue);
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 18}), State::kDue);
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 19}), State::kLate);
}

TEST(VisitPlan, CountsFromTheVisitOfDayZeroOnceItWasHeld) {
  SmallStudy study;
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V1", 0, 0, 10), NextStamp()), IsOk());
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V2", 14, -3, 3), NextStamp()), IsOk());
  const Subject subject = study.EnrolWithConsent("S001");
  OpenOn(study, subject, "V1", {2026, 5, 6});
  EXPECT_EQ(StateOn(study, "V1", {2026, 5, 7}), State::kDone);
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 16}), State::kWaiting) << "14 days after the 6th is the 20th";
  EXPECT_EQ(StateOn(study, "V2", {2026, 5, 17}), State::kDue);
}

TEST(VisitPlan, ASessionOutsideTheWindowIsNamedSo) {
  SmallStudy study;
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V2", 14, -3, 3), NextStamp()), IsOk());
  const Subject subject = study.EnrolWithConsent("S001");
  const auto within = store::PlanFor(study.record(), subject.id, "V2", {2026, 5, 18});
  ASSERT_THAT(within, IsOk());
  EXPECT_EQ((*within)->state, State::kDone);
  EXPECT_EQ((*store::PlanFor(study.record(), subject.id, "V2", {2026, 5, 19}))->state, State::kOutOfWindow);
  OpenOn(study, subject, "V2", {2026, 5, 30});
  EXPECT_EQ(StateOn(study, "V2", {2026, 6, 30}), State::kOutOfWindow);
}

TEST(VisitPlan, ForbidsVisitsThatItDoesNotName) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  EXPECT_EQ(*store::PlanFor(study.record(), subject.id, "V9", {2026, 5, 5}), std::nullopt) << "no plan, no rule";
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V1", 0, 0, 3), NextStamp()), IsOk());
  EXPECT_THAT(store::PlanFor(study.record(), subject.id, "V9", {2026, 5, 5}),
              FailsWith(ErrorCode::kRecordRefused, "V9 is not in the plan"));
}

TEST(VisitPlan, OfAnArmIsForItsSubjectsOnly) {
  SmallStudy study;
  const store::Arm arm{CountedId<store::ArmId>(), "A", "standard care"};
  const store::Arm other{CountedId<store::ArmId>(), "B", "new bandage"};
  ASSERT_THAT(store::AddArm(study.record(), arm, NextStamp()), IsOk());
  ASSERT_THAT(store::AddArm(study.record(), other, NextStamp()), IsOk());
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V2", 14, -3, 3, arm.id), NextStamp()), IsOk());
  const Subject subject = study.EnrolWithConsent("S001");
  EXPECT_TRUE(store::VisitStates(study.record(), {2026, 6, 1})->empty());
  ASSERT_THAT(store::AssignArm(study.record(), subject.id, arm.id, {2026, 5, 2}, "", NextStamp()), IsOk());
  EXPECT_EQ(StateOn(study, "V2", {2026, 6, 1}), State::kLate);
  EXPECT_THAT(store::AssignArm(study.record(), subject.id, other.id, {2026, 5, 3}, "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::AssignArm(study.record(), subject.id, other.id, {2026, 5, 3}, "wrong list", NextStamp()), IsOk());
  EXPECT_EQ((*store::ArmOf(study.record(), subject.id))->name, "B");
  EXPECT_TRUE(study->Check()->Passed());
}

TEST(VisitPlan, ChangesWithAReasonAndKeepsWhatWasPlanned) {
  SmallStudy study;
  const PlannedVisit first = Plan("V2", 14, -3, 3);
  ASSERT_THAT(store::PlanVisit(study.record(), first, NextStamp()), IsOk());
  EXPECT_THAT(store::PlanVisit(study.record(), Plan("V2", 15, -3, 3), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "planned already"));
  const PlannedVisit wider = Plan("V2", 14, -7, 7);
  EXPECT_THAT(store::ReplanVisit(study.record(), first.id, wider, "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::ReplanVisit(study.record(), first.id, wider, "amendment 1", NextStamp()), IsOk());
  EXPECT_EQ(store::VisitPlan(study.record())->size(), 1U);
  EXPECT_EQ(store::VisitPlan(study.record())->front().window_to, 7);
  EXPECT_EQ((*study->Describe(first.id.ToString()))["window_to"], "3");
  ASSERT_THAT(store::DropVisit(study.record(), wider.id, CountedId<PlannedVisitId>(), "amendment 2", NextStamp()),
              IsOk());
  EXPECT_TRUE(store::VisitPlan(study.record())->empty());
}

TEST(VisitPlan, WaitsForNobodyWhoWithdrew) {
  SmallStudy study;
  ASSERT_THAT(store::PlanVisit(study.record(), Plan("V2", 14, -3, 3), NextStamp()), IsOk());
  const Subject subject = study.EnrolWithConsent("S001");
  ASSERT_THAT(study->WithdrawConsent(subject.id, {2026, 5, 10}, "", NextStamp()), IsOk());
  EXPECT_EQ(StateOn(study, "V2", {2026, 6, 1}), State::kStopped);
}

TEST(VisitPlan, DaysFollowTheCalendarAcrossYearsAndLeapDays) {
  EXPECT_EQ(store::DayAfter({2027, 12, 31}, 1), (Date{2028, 1, 1}));
  EXPECT_EQ(store::DayAfter({2028, 2, 28}, 2), (Date{2028, 3, 1}));
  EXPECT_EQ(store::DayAfter({2028, 3, 1}, -1), (Date{2028, 2, 29}));
}

}  // namespace
}  // namespace striae::testing
