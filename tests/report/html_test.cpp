// The HTML report: complete, self-contained, and hostile text stays text.
#include <regex>
#include <set>

#include <gmock/gmock.h>

#include "report/report.h"
#include "tests/report/example_subject.h"

namespace striae::report {
namespace {

using ::testing::HasSubstr;
using testing::HeadSubject;
using ::testing::Not;
using testing::WoundSubject;

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The first element that is left open or closed out of order; empty when all are balanced.
std::string Unbalanced(const std::string& html) {
  static const std::set<std::string> kVoid = {"meta", "img", "col", "!DOCTYPE"};
  static const std::regex kTag(R"(<(/?)([!A-Za-z][A-Za-z0-9]*)((?:[^<>"]|"[^"]*")*)>)");
  std::vector<std::string> open;
  for (std::sregex_iterator at(html.begin(), html.end(), kTag), end; at != end; ++at) {
    const std::string name = (*at)[2];
    const std::string rest = (*at)[3];
    if (kVoid.contains(name) || (!rest.empty() && rest.back() == '/')) continue;
    if ((*at)[1] != "/") {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "/" + name;
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

TEST(HtmlReport, HasEveryPartOfTheReport) {
  const std::string html = HtmlReport(WoundSubject()).value();
  for (const char* part :
       {"Subject S001", "Study STR-01, Healing of leg ulcers", "LJ, Outpatient clinic 1", "NIKON D90 2000123",
        "1f2e3d4c5b6a", "striae 0.1.0", "V2 2026-05-18", "12.00 ± 0.30", "limit 0.83", "improved", "worse",
        "within error", "not assessable", "flag a: no healthy skin along 34 % of the boundary", "Missing and failed",
        "The subject was ill.", "1.96 √(u² + u₀²)", "2026-06-30 09:08 UTC"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  EXPECT_EQ(Count(html, "<svg"), 2U);
  EXPECT_EQ(Count(html, "src=\"data:image/jpeg;base64,"), 6U);  // photograph and depth map of three visits
  EXPECT_THAT(HtmlReport(HeadSubject()).value(), HasSubstr("turned 32 deg to the subject's left"));
}

TEST(HtmlReport, IsWellFormedAndSelfContained) {
  for (const SubjectReport& subject : {WoundSubject(), HeadSubject(), SubjectReport{}}) {
    const std::string html = HtmlReport(subject).value();
    EXPECT_EQ(Unbalanced(html), "");
    for (const char* outside : {"<script", "<link", "http:", "https:", "@import", "url("}) {
      EXPECT_THAT(html, Not(HasSubstr(outside)));
    }
  }
}

TEST(HtmlReport, CanBeHeardAsWellAsSeen) {
  const std::string html = HtmlReport(WoundSubject()).value();
  EXPECT_EQ(Count(html, "<img "), Count(html, "<img alt=\""));
  EXPECT_EQ(Count(html, "<img alt=\"\""), 0U);
  EXPECT_EQ(Count(html, "scope=\"col\""), 4U);  // quantity and three visits
  EXPECT_EQ(Count(html, "scope=\"row\""), 4U);  // three quantities and the flags
  EXPECT_THAT(html, HasSubstr("<html lang=\"en\">"));
  EXPECT_THAT(html, HasSubstr("V3 (day 28) 7.00 ± 0.30 cm²"));  // the plot in words
}

TEST(HtmlReport, KeepsHostileTextAsText) {
  const std::string hostile = "</td><script>alert(\"1\")</script>&<img src=x onerror=alert(1)>\xFF\x01";
  SubjectReport subject = WoundSubject();
  subject.study.title = subject.study.sponsor = subject.site.name = subject.subject.pseudonym = hostile;
  subject.devices = subject.calibrations = {hostile};
  for (VisitEntry& visit : subject.visits) {
    visit.name = visit.status = visit.missing = hostile;
    for (CaptureEntry& entry : visit.captures) {
      entry.capture.file_name = entry.capture.body_site = entry.capture.role.label = entry.failure = hostile;
      for (AnalysisReport& report : entry.analyses) {
        for (Measurement& m : report.measurements) {
          m.unit = m.reason = hostile;
          m.status = Measurement::Status::kFlagged;
        }
      }
    }
  }
  const std::string html = HtmlReport(subject).value();
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(html, Not(HasSubstr("\xFF")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&quot;1&quot;)"));
  EXPECT_EQ(Unbalanced(html), "");
}

TEST(HtmlReport, CopesWithPicturesThatAreAbsentOrDamaged) {
  SubjectReport subject = WoundSubject();
  subject.visits[0].captures[0].photograph = {0x89, 'P', 'N', 'G', 1, 2, 3, 4, 5, 6};
  subject.visits[0].captures[0].depth_map.clear();
  const std::string html = HtmlReport(subject).value();
  EXPECT_THAT(html, HasSubstr("the photograph cannot be shown"));
  EXPECT_THAT(html, HasSubstr("no depth map"));
  EXPECT_EQ(Count(html, "<img "), 4U);
}

TEST(HtmlReport, IsTheSameForTheSameInput) {
  EXPECT_EQ(HtmlReport(WoundSubject()).value(), HtmlReport(WoundSubject()).value());
}

TEST(HtmlReport, OfASubjectWithoutCapturesSaysSo) {
  SubjectReport subject;
  subject.subject.pseudonym = "S002";
  EXPECT_THAT(HtmlReport(subject).value(), HasSubstr("Nothing has been captured for this subject yet."));
}

}  // namespace
}  // namespace striae::report
