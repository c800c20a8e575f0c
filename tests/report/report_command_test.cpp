// `striae report` on a record, as a coordinator runs it.
#include <fstream>
#include <iterator>

#include "report/picture.h"
#include "tests/app/striae_program.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string Read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ReportCommand : public ::testing::Test {
 protected:
  /// A visit with a wound of that volume, whose depth is flagged, and its previews.
  void Measured(const std::string& visit, double volume_ml) {
    const Capture capture = study_.Import(study_.Open(subject_, visit), "photograph of " + visit);
    ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, volume_ml), NextStamp()),
                IsOk());
    for (const char* kind : {"preview-photo", "preview-depth"}) {
      store::Derived preview;
      preview.capture = capture.id;
      preview.kind = kind;
      preview.media_type = "image/png";
      preview.provenance.inputs = {{"photograph", capture.sha256}};
      const auto png = report::EncodePng(ImageRgb(30, 20, {120, 120, 120})).value();
      ASSERT_THAT(study_->AddDerived(preview, png, NextStamp()), IsOk());
    }
  }
  [[nodiscard]] Ran Report(const std::string& subject, const std::filesystem::path& out) const {
    return Striae({"-C", study_.folder().string(), "report", subject, "--out", out.string(), "--json"});
  }

  SmallStudy study_;
  Subject subject_ = study_.EnrolWithConsent("S001");
};

TEST_F(ReportCommand, WritesWhatTheRecordHolds) {
  Measured("V1", 4.0);
  Measured("V2", 2.0);
  study_.Open(subject_, "V3");
  const auto out = study_.dir() / "S001.html";
  const Ran ran = Report("S001", out);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("visits"), 3);
  EXPECT_EQ(ran.Json().at("format"), "html");
  const std::string html = Read(out);
  for (const char* part : {"Subject S001", "WND-01", "Example Clinic", "Volume", "V1", "V2", "data:image/jpeg;base64,",
                           "no captures", "flag a"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  const auto pdf = study_.dir() / "S001.pdf";
  ASSERT_EQ(Report("S001", pdf).exit_code, 0);
  EXPECT_EQ(Read(pdf).substr(0, 5), "%PDF-");
}

TEST_F(ReportCommand, ManagesWithoutPreviewsAndListsFailures) {
  const Capture capture = study_.Import(study_.Open(subject_), "photograph");
  AnalysisReport attempt = WoundReport(capture, 1);
  attempt.measurements.clear();
  const Error failure{ErrorCode::kNoCarrier, "no stripes: open the flash", {}};
  ASSERT_THAT(study_->AddFailure(CountedId<ReportId>(), capture.id, attempt, failure, NextStamp()), IsOk());
  const auto out = study_.dir() / "S001.html";
  const Ran ran = Report("S001", out);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(Read(out), HasSubstr("no stripes: open the flash"));
  EXPECT_THAT(Read(out), Not(HasSubstr("<img")));
}

TEST_F(ReportCommand, RefusesAnUnknownSubjectAndWritesNothing) {
  const auto out = study_.dir() / "S009.pdf";
  const Ran ran = Report("S009", out);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("S009"));
  EXPECT_EQ(ran.out, "");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(ReportCommand, SaysWhenItCannotWrite) {
  const Ran ran = Report("S001", study_.dir() / "absent/S001.pdf");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("cannot write"));
  EXPECT_EQ(ran.out, "");
}

TEST_F(ReportCommand, KnowsTwoKindsOfFile) {
  const Ran ran = Report("S001", study_.dir() / "S001.doc");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("end --out in"));
}

}  // namespace
}  // namespace striae::testing
