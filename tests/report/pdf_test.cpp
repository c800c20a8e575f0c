// The PDF report, read back with poppler's tools.
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>

#include "report/report.h"
#include "tests/report/example_subject.h"
#include "tests/support/program.h"
#include "tests/support/temp_dir.h"

namespace striae::report {
namespace {

using ::testing::HasSubstr;
using testing::HeadSubject;
using ::testing::Not;
using testing::WoundSubject;

/// What one of poppler's tools prints about a PDF.
std::string Poppler(const char* tool, const std::vector<std::uint8_t>& pdf, std::vector<std::string> after = {}) {
  const testing::TempDir dir;
  const std::string file = (dir / "report.pdf").string();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(pdf.data()), static_cast<std::streamsize>(pdf.size()));
  after.insert(after.begin(), file);
  return testing::RunProgram(tool, after).out;
}

#define STRIAE_NEED_POPPLER()                                                               \
  if (!testing::OnPath("pdftotext")) GTEST_SKIP() << "no pdftotext: install poppler-utils"; \
  static_assert(true)

TEST(PdfReport, IsOnePageA4) {
  STRIAE_NEED_POPPLER();
  for (const SubjectReport& subject : {WoundSubject(), HeadSubject()}) {
    const std::string info = Poppler("pdfinfo", PdfReport(subject).value());
    EXPECT_THAT(info, HasSubstr("Pages:           1\n"));
    EXPECT_THAT(info, HasSubstr("(A4)"));
  }
}

TEST(PdfReport, HasItsTextAsText) {
  STRIAE_NEED_POPPLER();
  const std::string text = Poppler("pdftotext", PdfReport(WoundSubject()).value(), {"-layout", "-"});
  for (const char* part :
       {"Subject S001", "Study STR-01", "NIKON D90 2000123", "12.00 ± 0.30", "limit 0.83", "improved", "worse",
        "within error", "not assessable", "flag a", "no healthy skin along 34 %", "Missing and failed",
        "The subject was ill.", "day 28", "page 1 of 1"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  const std::string head = Poppler("pdftotext", PdfReport(HeadSubject()).value(), {"-layout", "-"});
  EXPECT_THAT(head, HasSubstr("turned 32 deg to the subject's left"));
}

TEST(PdfReport, EmbedsItsFontsAndPictures) {
  STRIAE_NEED_POPPLER();
  const auto pdf = PdfReport(WoundSubject()).value();
  const std::string fonts = Poppler("pdffonts", pdf);
  EXPECT_THAT(fonts, HasSubstr(" yes "));
  EXPECT_THAT(fonts, Not(HasSubstr(" no  no ")));
  const std::string images = Poppler("pdfimages", pdf, {"-list"});
  EXPECT_EQ(std::count(images.begin(), images.end(), '\n'), 2 + 6);  // two header lines, two pictures for three visits
}

TEST(PdfReport, IsTheSameBytesForTheSameInput) {
  const auto pdf = PdfReport(WoundSubject()).value();
  EXPECT_EQ(pdf, PdfReport(WoundSubject()).value());
  SubjectReport later = WoundSubject();
  later.generated_at.unix_ms += 60'000;
  EXPECT_NE(pdf, PdfReport(later).value());
}

TEST(PdfReport, CarriesTheTimeOfItsMakingNotOfTheClock) {
  STRIAE_NEED_POPPLER();
  EXPECT_THAT(Poppler("pdfinfo", PdfReport(WoundSubject()).value(), {"-isodates"}),
              HasSubstr("CreationDate:    2026-06-30T09:08:07Z"));
}

TEST(PdfReport, TakesAsManyPagesAsManyVisitsNeed) {
  STRIAE_NEED_POPPLER();
  SubjectReport subject = WoundSubject();
  const VisitEntry visit = subject.visits[0];
  subject.visits.clear();
  for (int month = 1; month <= 12; ++month) {
    subject.visits.push_back(visit);
    subject.visits.back().name = "M" + std::to_string(month);
    subject.visits.back().date = {2026, month, 1};
  }
  const auto pdf = PdfReport(subject).value();
  EXPECT_THAT(Poppler("pdftotext", pdf, {"-layout", "-"}), HasSubstr("M12"));
  EXPECT_THAT(Poppler("pdftotext", pdf, {"-layout", "-"}), HasSubstr("page 2 of 2"));
}

TEST(PdfReport, KeepsMarkupInTextAsText) {
  STRIAE_NEED_POPPLER();
  SubjectReport subject = WoundSubject();
  subject.study.title = "<b>A & B</b> \xFF";
  EXPECT_THAT(Poppler("pdftotext", PdfReport(subject).value(), {"-layout", "-"}), HasSubstr("<b>A & B</b>"));
}

}  // namespace
}  // namespace striae::report
