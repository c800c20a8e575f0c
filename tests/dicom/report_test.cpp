// What our own check refuses before anything is written, and surface and report as bytes.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/ply.h"
#include "core/stl.h"
#include "dicom/body_site.h"
#include "dicom/check.h"
#include "dicom/measurement_report.h"
#include "dicom/surface_model.h"
#include "tests/dicom/samples.h"

namespace striae::dicom::testing {
namespace {

using ::testing::HasSubstr;

/// The sample report after `spoil` must be refused with words that name `reason`.
void ExpectRefused(const std::function<void(AnalysisReport&)>& spoil, const std::string& reason) {
  const ThreeObjects objects = MakeObjects();
  const std::vector<ObjectReference> evidence{objects.photo.reference, objects.surface.reference};
  AnalysisReport report = MakeWoundReport();
  ASSERT_TRUE(CheckReport(report, evidence));
  spoil(report);
  const auto verdict = CheckReport(report, evidence);
  ASSERT_FALSE(verdict) << reason;
  EXPECT_EQ(verdict.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(verdict.error().message, HasSubstr(reason));
  const MeasurementGroup group{MakeWoundCapture(), report, MakeContext().session.opened_at, evidence};
  EXPECT_FALSE(EncodeMeasurements(MakeContext(), {group}, 1));
}

TEST(SemanticCheck, RefusesAVolumeInDegrees) {
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].unit = "deg"; }, "does not fit the quantity Volume");
  ExpectRefused([](AnalysisReport& r) { r.measurements[1].unit = "mm"; }, "does not fit the quantity Area");
  ExpectRefused([](AnalysisReport& r) { r.measurements[3].unit = "cm2"; }, "does not fit");  // by its name alone
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].unit = "pint"; }, "not a UCUM unit");
}

TEST(SemanticCheck, RefusesNumbersThatAreNone) {
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].value = std::nan(""); }, "not a finite number");
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].uncertainty = std::numeric_limits<double>::infinity(); },
                "uncertainty");
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].uncertainty = -1; }, "uncertainty");
}

TEST(SemanticCheck, RefusesWhatDoesNotSayWhatItIs) {
  ExpectRefused([](AnalysisReport& r) { r.measurements.clear(); }, "no measurements");
  ExpectRefused([](AnalysisReport& r) { r.version.clear(); }, "version");
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].code.scheme.clear(); }, "lacks scheme");
  ExpectRefused([](AnalysisReport& r) { r.measurements[0].code.value = "12345678901234567"; }, "longer than DICOM");
  ExpectRefused([](AnalysisReport& r) { r.measurements[2].reason.clear(); }, "flagged without a reason");
}

TEST(SemanticCheck, RefusesNumbersWithoutTheirEvidence) {
  const ThreeObjects objects = MakeObjects();
  const AnalysisReport report = MakeWoundReport();
  EXPECT_THAT(CheckReport(report, {}).error().message, HasSubstr("no photograph"));
  EXPECT_THAT(CheckReport(report, {objects.surface.reference}).error().message, HasSubstr("no photograph"));
  EXPECT_THAT(CheckReport(report, {objects.photo.reference}).error().message, HasSubstr("no surface"));
  ObjectReference nameless = objects.surface.reference;
  nameless.sop_instance_uid.clear();
  EXPECT_THAT(CheckReport(report, {objects.photo.reference, nameless}).error().message, HasSubstr("without UIDs"));
}

TEST(Report, RefusesNumbersOfAnotherSession) {
  const ThreeObjects objects = MakeObjects();
  SessionContext other = MakeContext();
  other.session.id = SessionId(Uuid::Parse("f81d4fae-7dec-11d0-a765-00a0c91e6bf6").value());
  const MeasurementGroup group{MakeWoundCapture(),
                               MakeWoundReport(),
                               other.session.opened_at,
                               {objects.photo.reference, objects.surface.reference}};
  EXPECT_EQ(EncodeMeasurements(other, {group}, 1).error().code, ErrorCode::kUsage);
  EXPECT_EQ(EncodeMeasurements(other, {}, 1).error().code, ErrorCode::kUsage);
}

TEST(Surface, TheEncapsulatedStlIsTheThinnedSurface) {
  const ThreeObjects objects = MakeObjects();
  const auto thinned = ThinSurface(MakeSphere(40, 30, 300), 500).value();
  const auto stl = EncodeStl(thinned.surface, "Striae surface, mm, camera frame");
  EXPECT_NE(std::search(objects.surface.bytes.begin(), objects.surface.bytes.end(), stl.begin(), stl.end()),
            objects.surface.bytes.end());
}

TEST(Surface, RefusesTooManyFacesAndAStrangePhotograph) {
  const ThreeObjects objects = MakeObjects();
  ThinnedSurface large{MakeSphere(400, 300, 300)};  // 238602 faces
  EXPECT_EQ(EncodeSurface(MakeContext(), MakeWoundCapture(), large, objects.photo.reference, "1").error().code,
            ErrorCode::kUsage);
  const ThinnedSurface small{MakeSphere(20, 15, 300)};
  ObjectReference strange = objects.photo.reference;
  strange.study_uid = "2.25.1";
  EXPECT_EQ(EncodeSurface(MakeContext(), MakeWoundCapture(), small, strange, "1").error().code, ErrorCode::kUsage);
}

TEST(BodySite, KnowsTheWordsOfTheWard) {
  EXPECT_EQ(FindBodySite("Lower leg")->code.value, "30021000");
  EXPECT_EQ(FindBodySite("  lower-LEG ")->code.value, "30021000");
  EXPECT_FALSE(FindBodySite("stump of the left thigh"));
  EXPECT_EQ(SiteOf(MakeHeadCapture())->code.value, "69536005");
  EXPECT_TRUE(MayBeRecognizable(MakeHeadCapture()));
  EXPECT_FALSE(MayBeRecognizable(MakeWoundCapture()));
}

}  // namespace
}  // namespace striae::dicom::testing
