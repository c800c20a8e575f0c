// What a report says, before any layout.
#include "report/page.h"

#include <set>

#include <gmock/gmock.h>

#include "tests/report/example_subject.h"

namespace striae::report {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::HeadSubject;
using ::testing::IsEmpty;
using testing::WoundSubject;

const Cell& CellOf(const Section& section, const std::string& label, std::size_t column) {
  for (const Row& row : section.rows) {
    if (row.label == label) return row.cells.at(column);
  }
  throw std::out_of_range(label);
}

TEST(Page, JudgesEachVisitAgainstTheFirst) {
  const Page page = BuildPage(WoundSubject());
  ASSERT_EQ(page.sections.size(), 1U);
  const Section& wound = page.sections[0];
  EXPECT_EQ(wound.title, "Wound W1, left calf");
  EXPECT_FALSE(CellOf(wound, "Area", 0).has_verdict);
  EXPECT_EQ(CellOf(wound, "Area", 1).value, "10.50 ± 0.30");
  EXPECT_EQ(CellOf(wound, "Area", 1).change, "\u22121.50 (\u221212\u00a0%)");
  EXPECT_EQ(CellOf(wound, "Area", 1).limit, "limit 0.83");
  EXPECT_EQ(CellOf(wound, "Area", 1).verdict, Verdict::kImproved);
  EXPECT_EQ(CellOf(wound, "Volume", 1).verdict, Verdict::kWithinError);
  EXPECT_EQ(CellOf(wound, "Deepest point", 1).verdict, Verdict::kWorse);
  EXPECT_EQ(CellOf(wound, "Deepest point", 2).verdict, Verdict::kWithinError);
}

TEST(Page, NeverShowsAFlaggedNumberWithoutItsFlag) {
  const Section wound = BuildPage(WoundSubject()).sections.at(0);
  EXPECT_EQ(CellOf(wound, "Volume", 2).flag, "a");
  EXPECT_EQ(CellOf(wound, "Volume", 2).verdict, Verdict::kNotAssessable);
  EXPECT_THAT(wound.columns[2].notes, ElementsAre("flag a: no healthy skin along 34 % of the boundary"));
  EXPECT_EQ(wound.headlines.at(1).label, "Volume");
  EXPECT_EQ(wound.headlines.at(1).cell.flag, "a");
  EXPECT_THAT(wound.plots.at(1).description, HasSubstr("1.90 ± 0.20 mL, flagged"));
}

TEST(Page, NumbersTheDaysFromTheFirstVisit) {
  const Section wound = BuildPage(WoundSubject()).sections.at(0);
  EXPECT_EQ(wound.columns[0].day, "day 0");
  EXPECT_EQ(wound.columns[2].day, "day 28");
  EXPECT_EQ(wound.columns[2].date, "2026-06-01");
}

TEST(Page, OrdersVisitsByDateNotByName) {
  SubjectReport subject = WoundSubject();
  std::reverse(subject.visits.begin(), subject.visits.end());
  const Section wound = BuildPage(subject).sections.at(0);
  EXPECT_EQ(wound.columns[0].visit, "V1");
  EXPECT_EQ(CellOf(wound, "Area", 2).verdict, Verdict::kImproved);
}

TEST(Page, ListsFailedAndMissingCapturesWithTheirReasons) {
  SubjectReport subject = WoundSubject();
  subject.visits[0].captures.push_back({});
  subject.visits[0].captures.back().capture.file_name = "DSC_0009.JPG";
  const Page page = BuildPage(subject);
  EXPECT_THAT(page.missing,
              ElementsAre(AllOf(HasSubstr("V1"), HasSubstr("DSC_0009.JPG"), HasSubstr("no role was given")),
                          AllOf(HasSubstr("V3"), HasSubstr("wound:W2"), HasSubstr("draw it again")),
                          AllOf(HasSubstr("V4"), HasSubstr("The subject was ill"))));
}

TEST(Page, SaysHeadAnglesInWordsAndJudgesTheirSize) {
  const Page page = BuildPage(HeadSubject());
  ASSERT_EQ(page.sections.size(), 1U);
  const Section& head = page.sections[0];
  EXPECT_EQ(CellOf(head, "Rotation", 0).words, "turned 32 deg to the subject's left");
  EXPECT_EQ(CellOf(head, "Rotation", 1).verdict, Verdict::kImproved);
  EXPECT_EQ(CellOf(head, "Flexion", 1).verdict, Verdict::kWorse);
  EXPECT_EQ(CellOf(head, "Tilt", 1).verdict, Verdict::kWithinError);
  EXPECT_EQ(head.plots.size(), 1U);
  EXPECT_THAT(page.missing, IsEmpty());  // a neutral pose has no values of its own

  SubjectReport mobility = HeadSubject();
  mobility.head_goal = HeadGoal::kWiderMovement;
  EXPECT_EQ(CellOf(BuildPage(mobility).sections[0], "Rotation", 1).verdict, Verdict::kWorse);
}

TEST(Page, AveragesRepeatsWithoutShrinkingTheirCommonError) {
  SubjectReport subject = WoundSubject();
  CaptureEntry repeat = subject.visits[0].captures[0];
  repeat.analyses[0].measurements[1].value = 13.0;  // area, beside 12.0: standard error of the mean 0.5 > u = 0.3
  subject.visits[0].captures.push_back(repeat);
  const Section wound = BuildPage(subject).sections.at(0);
  EXPECT_EQ(CellOf(wound, "Area", 0).value, "12.50 ± 0.50");
  EXPECT_EQ(CellOf(wound, "Volume", 0).value, "4.00 ± 0.20");
  EXPECT_THAT(wound.columns[0].notes, Contains("mean of 2 captures"));
}

TEST(Page, LeavesAFlaggedRepeatOutAndSaysSo) {
  SubjectReport subject = WoundSubject();
  CaptureEntry repeat = subject.visits[0].captures[0];
  Measurement& area = repeat.analyses[0].measurements[1];
  area.value = 99;
  area.status = Measurement::Status::kFlagged;
  area.reason = "blurred";
  subject.visits[0].captures.push_back(repeat);
  const Section wound = BuildPage(subject).sections.at(0);
  EXPECT_EQ(CellOf(wound, "Area", 0).value, "12.00 ± 0.30");
  EXPECT_EQ(CellOf(wound, "Area", 0).flag, "");
  EXPECT_THAT(wound.columns[0].notes, Contains("a flagged repeat is left out: blurred"));
}

TEST(Page, SaysWhichVisitStandsInForAFirstWithoutValues) {
  SubjectReport subject = WoundSubject();
  subject.visits[0].captures[0].analyses.clear();
  subject.visits[0].captures[0].failure = "no stripes";
  const Section wound = BuildPage(subject).sections.at(0);
  EXPECT_EQ(CellOf(wound, "Area", 0).value, "no value");
  EXPECT_EQ(CellOf(wound, "Area", 2).change, "\u22123.50 (\u221233\u00a0%)");
  EXPECT_THAT(wound.notes, Contains(HasSubstr("No value at V1; changes are against V2")));
}

TEST(Page, PlotsVisitsOfOneDaySideBySide) {
  SubjectReport subject = WoundSubject();
  for (VisitEntry& visit : subject.visits) visit.date = {2026, 5, 4};
  const Drawing plot = BuildPage(subject).sections.at(0).plots.at(0);
  std::set<double> places;
  for (const Shape& shape : plot.shapes) {
    if (shape.kind == Shape::Kind::kText && shape.text == "day 0") places.insert(shape.points[0].x);
  }
  EXPECT_EQ(places.size(), 3U);
}

TEST(Page, WarnsOfWithdrawnConsent) {
  SubjectReport subject = WoundSubject();
  subject.subject.consent_withdrawn = Date{2026, 6, 20};
  EXPECT_THAT(BuildPage(subject).warnings, ElementsAre(HasSubstr("withdrawn on 2026-06-20")));
}

TEST(Page, StatesTheFormulaOfTheVerdict) {
  EXPECT_THAT(BuildPage(WoundSubject()).footer, Contains(HasSubstr("1.96 √(u² + u₀²)")));
}

}  // namespace
}  // namespace striae::report
