// Outlines, derived files and what processing came to.
#include <limits>

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using ::testing::IsEmpty;

class Processing : public ::testing::Test {
 protected:
  Processing() {
    session_ = study_.Open(study_.EnrolWithConsent("S001"));
    Capture capture = SmallStudy::Photograph(session_);
    capture.metadata.width_px = 100;
    capture.metadata.height_px = 80;
    capture_ = study_->AddCapture(capture, Bytes("photo"), NextStamp())->capture;
  }
  SmallStudy study_;
  Session session_;
  Capture capture_;
};

TEST_F(Processing, TheNewestOutlineCounts) {
  EXPECT_EQ(*study_->LatestOutline(capture_.id), std::nullopt);
  const Outline triangle{{{10, 10}, {20, 10}, {15.25, 20}}, {}};
  const Outline square{{{10, 10}, {20, 10}, {20, 20}, {10, 20}}, capture_.sha256};
  ASSERT_THAT(study_->AddOutline(CountedId<OutlineId>(), capture_.id, triangle, NextStamp()), IsOk());
  study_.Reopen();
  auto latest = *study_->LatestOutline(capture_.id);
  EXPECT_EQ(latest->outline.polygon_px, triangle.polygon_px);
  EXPECT_EQ(latest->outline.image_sha256, capture_.sha256) << "it is tied to the photograph when it is kept";
  EXPECT_EQ(latest->drawn_by, "coordinator");
  const auto second = study_->AddOutline(CountedId<OutlineId>(), capture_.id, square, NextStamp());
  latest = *study_->LatestOutline(capture_.id);
  EXPECT_EQ(latest->id, second->id);
  EXPECT_EQ(latest->outline.polygon_px, square.polygon_px);
  EXPECT_EQ(study_->AddOutline(CountedId<OutlineId>(), capture_.id, square, NextStamp())->id, second->id);
}

TEST_F(Processing, AnOutlineBelongsToItsPhotograph) {
  const auto add = [&](const Outline& outline) {
    return study_->AddOutline(CountedId<OutlineId>(), capture_.id, outline, NextStamp());
  };
  EXPECT_THAT(add({{{10, 10}, {20, 10}, {15, 20}}, store::HashOf(Bytes("another photo"))}),
              FailsWith(ErrorCode::kRecordRefused, "another photograph"));
  EXPECT_THAT(add({{{10, 10}, {99.6, 10}, {15, 20}}, {}}), FailsWith(ErrorCode::kBadFile, "100 x 80"));
  EXPECT_THAT(add({{{10, 10}, {99.4, 10}, {15, 20}}, {}}), IsOk()) << "the last pixel reaches to 99.5";
  EXPECT_THAT(add({{{10, 10}, {20, 10}}, {}}), FailsWith(ErrorCode::kBadFile, "three points"));
  EXPECT_THAT(
      study_->AddOutline(CountedId<OutlineId>(), CountedId<CaptureId>(), {{{0, 0}, {1, 0}, {1, 1}}, {}}, NextStamp()),
      FailsWith(ErrorCode::kNotFound, "no capture"));
}

TEST_F(Processing, ASurfaceIsKeptCompressedAndComesBackByteForByte) {
  const std::string ply(100'000, 'p');
  store::Derived surface;
  surface.capture = capture_.id;
  surface.kind = "surface";
  surface.media_type = "model/x-ply";
  surface.provenance.version = "0.1.0";
  surface.provenance.inputs = {{"photograph", capture_.sha256}};
  surface.provenance.parameters = {{"window", "hann"}};
  const auto kept = study_->AddDerived(surface, Bytes(ply), NextStamp());
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->sha256, store::HashOf(Bytes(ply)));
  EXPECT_LT(std::filesystem::file_size(study_->objects().PathOf(kept->object)), ply.size() / 10);
  study_.Reopen();
  const auto latest = *study_->LatestDerived(capture_.id, "surface");
  ASSERT_TRUE(latest);
  EXPECT_EQ(latest->size_bytes, ply.size());
  EXPECT_EQ(latest->media_type, "model/x-ply");
  EXPECT_EQ(latest->provenance.inputs.front().sha256, capture_.sha256);
  EXPECT_EQ(latest->provenance.parameters, surface.provenance.parameters);
  const auto bytes = study_->ReadDerived(*latest);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), ply);
  EXPECT_EQ(*study_->LatestDerived(capture_.id, "preview-depth"), std::nullopt);
}

TEST_F(Processing, TheSameDerivedFileTwiceIsOne) {
  store::Derived preview;
  preview.capture = capture_.id;
  preview.kind = "preview-depth";
  preview.media_type = "image/png";
  for (int i = 0; i < 2; ++i) ASSERT_THAT(study_->AddDerived(preview, Bytes("png"), NextStamp()), IsOk());
  EXPECT_EQ(study_->DerivedOf(capture_.id)->size(), 1U);
  ASSERT_THAT(study_->AddDerived(preview, Bytes("png 2"), NextStamp()), IsOk());
  ASSERT_THAT(study_->AddDerived(preview, Bytes("png"), NextStamp()), IsOk());
  EXPECT_EQ(study_->DerivedOf(capture_.id)->size(), 3U) << "back to the first file is a change again";
  EXPECT_EQ((*study_->LatestDerived(capture_.id, "preview-depth"))->sha256, store::HashOf(Bytes("png")));
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Processing, ALostDerivedFileComesBackWhenItIsMadeAgain) {
  store::Derived surface;
  surface.capture = capture_.id;
  surface.kind = "surface";
  const auto kept = study_->AddDerived(surface, Bytes("ply"), NextStamp());
  std::filesystem::remove(study_->objects().PathOf(kept->object));
  EXPECT_THAT(study_->ReadDerived(*kept), FailsWith(ErrorCode::kNotFound, "missing"));
  ASSERT_THAT(study_->AddDerived(surface, Bytes("ply"), NextStamp()), IsOk());
  EXPECT_THAT(study_->ReadDerived(*kept), IsOk());
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Processing, MeasurementsStandInTheirPlaceInTheStudy) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp()), IsOk());
  study_.Reopen();
  const auto rows = study_->Results();
  ASSERT_EQ(rows->size(), 2U);
  const store::ResultRow& volume = rows->front();
  EXPECT_EQ(volume.subject.pseudonym, "S001");
  EXPECT_EQ(volume.visit.name, "V1");
  EXPECT_EQ(volume.session, session_.id);
  EXPECT_EQ(volume.capture, capture_.id);
  EXPECT_EQ(volume.role.ToString(), "wound:W1");
  EXPECT_EQ(volume.analysis, "wound");
  EXPECT_EQ(volume.measurement.name, "volume");
  EXPECT_EQ(volume.measurement.value, 3.5);
  EXPECT_EQ(volume.measurement.unit, "mL");
  EXPECT_EQ(volume.measurement.uncertainty, 0.25);
  EXPECT_EQ(volume.measurement.code.value, "118565006");
  EXPECT_EQ(volume.measurement.equivalents.size(), 1U);
  EXPECT_EQ(rows->back().measurement.status, Measurement::Status::kFlagged);
  EXPECT_EQ(rows->back().measurement.reason, "a hole at the deepest place");
  const auto outcome = study_->OutcomeById(volume.report);
  EXPECT_EQ(outcome->report.details.at("axes_source"), "camera");
  EXPECT_EQ(outcome->report.provenance.inputs.front().sha256, capture_.sha256);
}

TEST_F(Processing, ResultsAreThoseOfOneSubjectWhenAsked) {
  const Session other = study_.Open(study_.EnrolWithConsent("S002"));
  const Capture capture = study_.Import(other, "other photo");
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 1), NextStamp()), IsOk());
  EXPECT_THAT(*study_->Results({session_.subject, {}, false}), IsEmpty());
  EXPECT_EQ(study_->Results({other.subject, {}, false})->size(), 2U);
  EXPECT_EQ(study_->Results({{}, other.id, false})->size(), 2U);
  EXPECT_THAT(study_->Results({CountedId<SubjectId>(), {}, false}), FailsWith(ErrorCode::kNotFound, "subject"));
}

TEST_F(Processing, ANewReportSupersedesAndTheOldOneStays) {
  const auto first = study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
  const auto second = study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.6), NextStamp());
  EXPECT_EQ(second->supersedes, first->id);
  ASSERT_EQ(study_->Results()->size(), 2U);
  EXPECT_EQ(study_->Results()->front().measurement.value, 3.6);
  const auto all = study_->Results({{}, {}, true});
  ASSERT_EQ(all->size(), 4U);
  EXPECT_TRUE(all->front().superseded);
  EXPECT_EQ(all->front().measurement.value, 3.5);
  EXPECT_EQ(study_->Outcomes(capture_.id)->size(), 2U);
}

TEST_F(Processing, TheSameReportAgainIsThereAlready) {
  const auto first = study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
  const auto again = study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
  EXPECT_EQ(again->id, first->id);
  EXPECT_EQ(study_->Outcomes(capture_.id)->size(), 1U);
}

TEST_F(Processing, AFailureIsAnOutcomeWithItsReason) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp()), IsOk());
  AnalysisReport attempted = WoundReport(capture_, 0);
  attempted.measurements.clear();
  const Error why{ErrorCode::kNoCarrier, "no stripes; check the flash", {"finding the carrier", "DSC_0001.JPG"}};
  ASSERT_THAT(study_->AddFailure(CountedId<ReportId>(), capture_.id, attempted, why, NextStamp()), IsOk());
  study_.Reopen();
  const auto items = study_->Work(session_.id);
  ASSERT_EQ(items->size(), 1U);
  ASSERT_EQ(items->front().outcomes.size(), 1U);
  const store::Outcome& outcome = items->front().outcomes.front();
  ASSERT_TRUE(outcome.failure);
  EXPECT_EQ(outcome.failure->code, ErrorCode::kNoCarrier);
  EXPECT_EQ(outcome.failure->Describe(), why.Describe());
  EXPECT_EQ(outcome.analysis, "wound");
  EXPECT_THAT(*study_->Results(), IsEmpty()) << "the outcome in force has no numbers";
  EXPECT_EQ(study_->GetOverview()->failed_captures, 1);
}

TEST_F(Processing, RefusesNumbersThatAreNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, bad), NextStamp()),
                FailsWith(ErrorCode::kBadFile, "not finite"));
  }
  EXPECT_THAT(study_->AddFailure(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 1), {}, NextStamp()),
              FailsWith(ErrorCode::kUsage, "no measurements"));
  EXPECT_THAT(study_->AddReport(CountedId<ReportId>(), CountedId<CaptureId>(), WoundReport(capture_, 1), NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no capture"));
  EXPECT_THAT(*study_->Outcomes(capture_.id), IsEmpty());
}

TEST_F(Processing, WorkLeavesOutPhotographsWithoutARole) {
  study_.Import(session_, "target", "unassigned");
  EXPECT_EQ(study_->Work(session_.id)->size(), 1U);
  EXPECT_EQ(study_->Work()->size(), 1U);
  EXPECT_THAT(study_->Work(CountedId<SessionId>()), FailsWith(ErrorCode::kNotFound, "no session"));
  const auto overview = *study_->GetOverview();
  EXPECT_EQ(overview.captures, 2);
  EXPECT_EQ(overview.unassigned_captures, 1);
  EXPECT_EQ(overview.unprocessed_captures, 1);
  EXPECT_EQ(overview.wounds_without_outline, 1);
  EXPECT_EQ(overview.subjects_with_consent, 1);
  EXPECT_EQ(overview.open_sessions, 1);
}

}  // namespace
}  // namespace striae::testing
