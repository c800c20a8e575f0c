// From the study record to DICOM files: what is exported, that it is stable, and that a failure leaves nothing behind.
#include <algorithm>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/dicom_session.h"
#include "app/study.h"
#include "core/ply.h"
#include "tests/dicom/samples.h"
#include "tests/dicom/tools.h"
#include "tests/support/temp_dir.h"

namespace striae::dicom::testing {
namespace {

using app::ExportSession;
using app::NewId;
using app::NewStamp;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// A study of one consenting subject with one session.
class RecordExport : public ::testing::Test {
 protected:
  void SetUp() override {
    const SessionContext sample = MakeContext();
    record_.emplace(
        store::Record::Create(folder_ / "study", sample.study, sample.site, app::NewUuid(), NewStamp()).value());
    ASSERT_TRUE(record_->AddSubject(sample.subject, NewStamp()));
    ASSERT_TRUE(record_->GiveConsent(sample.subject.id, *Date::Parse("2026-01-02"), NewStamp()));
    session_ = OpenSession("V1");
  }
  SessionId OpenSession(const std::string& visit) {
    Session session = MakeContext().session;
    session.id = NewId<SessionId>();
    session.operator_name = "operator";
    return record_->OpenSession(session, visit, NewId<VisitId>(), NewStamp()).value().id;
  }
  /// A photograph of its own width, so that no two are the same file.
  Capture AddPhoto(const SessionId& session, const CaptureRole& role, int width_px) {
    Capture capture = MakeWoundCapture();
    capture.id = NewId<CaptureId>();
    capture.session = session;
    capture.role = role;
    capture.metadata.width_px = width_px;
    capture.metadata.height_px = 47;
    return record_->AddCapture(capture, MakeJpeg(JpegKind::kColour422, width_px), NewStamp()).value().capture;
  }
  Sha256 AddSurface(const Capture& capture, double radius_mm = 300) {
    store::Derived derived;
    derived.capture = capture.id;
    derived.kind = "surface";
    derived.media_type = "application/ply";
    derived.provenance.version = "0.1.0";
    return record_->AddDerived(derived, EncodePly(MakeSphere(40, 30, radius_mm)), NewStamp()).value().sha256;
  }
  void AddNumbers(const Capture& capture, AnalysisReport report, std::vector<ProvenanceInput> inputs) {
    report.provenance.inputs = std::move(inputs);
    ASSERT_TRUE(record_->AddReport(NewId<ReportId>(), capture.id, report, NewStamp()));
  }
  /// Name and content of every file in a folder.
  static std::map<std::string, std::vector<std::uint8_t>> FilesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::vector<std::uint8_t>> files;
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      files[entry.path().filename().string()] = ReadBytes(entry.path());
    }
    return files;
  }
  static std::vector<std::string> Kinds(const app::SessionExport& exported) {
    std::vector<std::string> kinds;
    for (const auto& object : exported.objects) kinds.emplace_back(ToString(object.reference.kind));
    return kinds;
  }

  striae::testing::TempDir folder_;
  std::optional<store::Record> record_;
  SessionId session_;
  const CaptureRole wound_{CaptureRole::Kind::kWound, "W1"};
};

TEST_F(RecordExport, GivesPhotographSurfaceAndReportThatConform) {
  STRIAE_NEED_TOOL("dciodvfy");
  const Capture capture = AddPhoto(session_, wound_, 61);
  const Sha256 surface = AddSurface(capture);
  AddNumbers(capture, MakeWoundReport(), {{"photograph", capture.sha256}, {"surface", surface}});
  const auto exported = ExportSession(*record_, session_, false, folder_ / "out");
  ASSERT_TRUE(exported) << exported.error().Describe();
  EXPECT_THAT(Kinds(*exported), UnorderedElementsAre("photo", "surface", "measurements"));
  EXPECT_THAT(exported->left_out, IsEmpty());
  EXPECT_EQ(FilesIn(folder_ / "out").size(), 3U);
  for (const auto& object : exported->objects) {
    const ToolResult verdict = RunTool({"dciodvfy", "-new", (folder_ / "out" / object.file_name).string()});
    EXPECT_EQ(verdict.exit_code, 0) << verdict.output;
  }
}

TEST_F(RecordExport, ASecondExportChangesNothing) {
  const Capture capture = AddPhoto(session_, wound_, 61);
  AddNumbers(capture, MakeWoundReport(), {{"photograph", capture.sha256}, {"surface", AddSurface(capture)}});
  ASSERT_TRUE(ExportSession(*record_, session_, false, folder_ / "out"));
  const auto before = FilesIn(folder_ / "out");
  ASSERT_TRUE(ExportSession(*record_, session_, false, folder_ / "out"));
  EXPECT_EQ(FilesIn(folder_ / "out"), before);
  // Another photograph of the session leaves the first one's object as it was.
  AddPhoto(session_, {}, 64);
  ASSERT_TRUE(ExportSession(*record_, session_, false, folder_ / "out"));
  const auto after = FilesIn(folder_ / "out");
  EXPECT_EQ(after.size(), before.size() + 1);
  for (const auto& [name, bytes] : before) EXPECT_EQ(after.at(name), bytes) << name;
}

TEST_F(RecordExport, TheReportRefersToTheSurfaceThatItsNumbersCameFrom) {
  const Capture capture = AddPhoto(session_, wound_, 61);
  const Sha256 measured = AddSurface(capture, 300);
  AddNumbers(capture, MakeWoundReport(), {{"photograph", capture.sha256}, {"surface", measured}});
  const auto before = ExportSession(*record_, session_, false, folder_ / "before");
  ASSERT_TRUE(before);
  AddSurface(capture, 400);  // made later, not measured yet
  const auto after = ExportSession(*record_, session_, false, folder_ / "after");
  ASSERT_TRUE(after);
  EXPECT_EQ(FilesIn(folder_ / "before"), FilesIn(folder_ / "after"));
}

TEST_F(RecordExport, AHeadReportNamesTheNeutralPoseOfAnEarlierSession) {
  const Capture neutral = AddPhoto(session_, {CaptureRole::Kind::kNeutral, ""}, 61);
  const auto first = ExportSession(*record_, session_, false, folder_ / "first");
  ASSERT_TRUE(first);
  const SessionId later = OpenSession("V2");
  const Capture pose = AddPhoto(later, {CaptureRole::Kind::kPose, ""}, 64);
  AddNumbers(pose, MakeHeadReport(),
             {{"photograph", pose.sha256}, {"neutral photograph", neutral.sha256}, {"surface", AddSurface(pose)}});
  const auto second = ExportSession(*record_, later, false, folder_ / "second");
  ASSERT_TRUE(second) << second.error().Describe();
  const auto files = FilesIn(folder_ / "second");
  const auto& report = files.at(second->objects.back().file_name);
  const std::string& uid = first->objects.front().reference.sop_instance_uid;
  EXPECT_NE(std::search(report.begin(), report.end(), uid.begin(), uid.end()), report.end());
}

TEST_F(RecordExport, WhatHasNoObjectIsSaidWithItsReason) {
  AddPhoto(session_, wound_, 61);  // without a surface
  const auto exported = ExportSession(*record_, session_, false, folder_ / "out");
  ASSERT_TRUE(exported);
  EXPECT_THAT(Kinds(*exported), UnorderedElementsAre("photo"));
  ASSERT_EQ(exported->left_out.size(), 1U);
  EXPECT_THAT(exported->left_out[0].reason, HasSubstr("striae process"));
}

TEST_F(RecordExport, NothingLeavesTheStudyAfterConsentWasWithdrawn) {
  AddPhoto(session_, wound_, 61);
  ASSERT_TRUE(record_->WithdrawConsent(MakeContext().subject.id, *Date::Parse("2026-06-01"), "asked to", NewStamp()));
  const auto refused = ExportSession(*record_, session_, false, folder_ / "out");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kRecordRefused);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(RecordExport, AFailureLeavesNothingBehind) {
  const Capture capture = AddPhoto(session_, wound_, 61);
  AnalysisReport report = MakeWoundReport();
  report.measurements[0].unit = "deg";  // a volume in degrees: found after the photograph was written
  AddNumbers(capture, report, {{"photograph", capture.sha256}, {"surface", AddSurface(capture)}});
  const auto refused = ExportSession(*record_, session_, false, folder_ / "out");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(RecordExport, AnEmptyOrUnknownSessionIsRefused) {
  EXPECT_EQ(ExportSession(*record_, session_, false, folder_ / "out").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(ExportSession(*record_, NewId<SessionId>(), false, folder_ / "out").error().code, ErrorCode::kNotFound);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(RecordExport, AFolderThatCannotBeWrittenIsNamed) {
  AddPhoto(session_, wound_, 61);
  WriteBytes(folder_ / "file", {1});
  const auto refused = ExportSession(*record_, session_, false, folder_ / "file" / "out");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_THAT(refused.error().message, HasSubstr("choose a folder that you may write to"));
}

}  // namespace
}  // namespace striae::dicom::testing
