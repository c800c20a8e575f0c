// `striae import` and `striae capture` as a coordinator runs them, on a study made for the test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/record.h"
#include "tests/support/files.h"
#include "tests/support/ids.h"
#include "tests/support/program.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/ptp_responder.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_data.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::PtpBytes;
using testing::PtpFault;
using testing::Ran;
using testing::ReadBytes;
using testing::SomeId;
using testing::WriteBytes;

PtpBytes Photo(int iso = 400) {
  testing::PhotoOptions options;
  options.iso = iso;  // makes different photographs
  return testing::MakeJpeg(options);
}

/// A study with one consenting subject and an open session.
class StudyCommands : public ::testing::Test {
 protected:
  void SetUp() override {
    stamp_.now.unix_ms = 1777878489000;  // 2026-05-04
    stamp_.user = "coordinator";
    stamp_.machine = "test";
    Study study;
    study.id = SomeId<StudyId>(1);
    study.protocol = "P-1";
    study.title = "Test of intake";
    Site site;
    site.id = SomeId<SiteId>(2);
    site.code = "A";
    auto record = store::Record::Create(folder_ / "trial", study, site, SomeId<StudyId>(9).uuid(), stamp_);
    ASSERT_TRUE(record) << record.error().Describe();
    Subject subject;
    subject.id = subject_;
    subject.pseudonym = "S001";
    subject.site = site.id;
    ASSERT_TRUE(record->AddSubject(subject, stamp_));
    ASSERT_TRUE(record->GiveConsent(subject_, {2026, 5, 1}, stamp_));
    Session session;
    session.id = session_;
    session.subject = subject_;
    session.operator_name = "coordinator";
    session.opened_at = stamp_.now;
    const auto opened = record->OpenSession(session, "V1", SomeId<VisitId>(5), stamp_);
    ASSERT_TRUE(opened) << opened.error().Describe();
  }

  [[nodiscard]] store::Record Open() const {
    auto record = store::Record::Open(folder_ / "trial", stamp_);
    if (!record) throw std::runtime_error(record.error().Describe());
    return std::move(*record);
  }
  [[nodiscard]] std::vector<Capture> Captures() const {
    auto captures = Open().Captures(session_);
    if (!captures) throw std::runtime_error(captures.error().Describe());
    return *captures;
  }
  [[nodiscard]] Ran Striae(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"-C", (folder_ / "trial").string()});
    return testing::RunProgram(fs::path(STRIAE_BINARY_DIR) / "striae", arguments);
  }
  [[nodiscard]] Ran Import(std::vector<std::string> more) const {
    more.insert(more.begin(), {"import", "--json", "--session", session_.ToString()});
    return Striae(more);
  }
  [[nodiscard]] Ran CaptureFrom(const testing::PtpResponder& camera, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"capture", "--json", "--session", session_.ToString(), "--port", camera.PortName()});
    return Striae(more);
  }
  [[nodiscard]] std::size_t Quarantined() const {  // a file and its note each
    std::error_code absent;
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "trial/quarantine", absent)) ++files;
    return files / 2;
  }

  testing::TempDir folder_;
  store::Stamp stamp_;
  SubjectId subject_ = SomeId<SubjectId>(3);
  SessionId session_ = SomeId<SessionId>(4);
};

using ImportCommand = StudyCommands;
using CaptureCommand = StudyCommands;

TEST_F(ImportCommand, PhotographsEnterTheSessionWithTheirRole) {
  WriteBytes(folder_ / "card/DCIM/100NCD90/DSC_0001.JPG", Photo(200));
  WriteBytes(folder_ / "card/DCIM/100NCD90/DSC_0002.JPG", Photo(400));
  const Ran ran = Import({(folder_ / "card").string(), "--as", "wound:W1", "--site", "calf", "--laterality", "L"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  ASSERT_TRUE(ran.Json().is_object()) << ran.out;
  EXPECT_EQ(ran.Json()["added"], 2);
  const auto captures = Captures();
  ASSERT_EQ(captures.size(), 2U);
  EXPECT_EQ(captures[0].role.ToString(), "wound:W1");
  EXPECT_EQ(captures[0].body_site, "calf");
  EXPECT_EQ(captures[0].laterality, Laterality::kLeft);
  EXPECT_EQ(captures[0].sha256.ToString(), ran.Json()["files"][0]["sha256"]);
  EXPECT_EQ(Open().objects().Get(captures[0].sha256).value(), Photo(200));
}

TEST_F(ImportCommand, BrokenFilesGoToQuarantineAndTheRestGoesIn) {
  PtpBytes truncated = Photo(200);
  truncated.resize(truncated.size() / 2);
  const std::string text = "not a photograph at all";
  WriteBytes(folder_ / "in/a_truncated.JPG", truncated);
  WriteBytes(folder_ / "in/b_text.JPG", PtpBytes(text.begin(), text.end()));
  WriteBytes(folder_ / "in/c_good.JPG", Photo());
  const Ran ran = Import({(folder_ / "in").string()});
  EXPECT_EQ(ran.exit_code, 1);
  const auto json = ran.Json();
  ASSERT_TRUE(json.is_object()) << ran.out;
  EXPECT_EQ(json["added"], 1);
  EXPECT_EQ(json["failed"], 2);
  EXPECT_EQ(json["files"][0]["status"], "quarantined");
  EXPECT_EQ(json["files"][0]["error"]["code"], "bad-image");
  EXPECT_EQ(json["files"][2]["status"], "added");
  EXPECT_EQ(Captures().size(), 1U);
  const fs::path kept = json["files"][0]["quarantine"].get<std::string>();
  EXPECT_EQ(ReadBytes(kept), truncated);
  const PtpBytes note = ReadBytes(kept.string() + ".why.json");
  EXPECT_THAT(std::string(note.begin(), note.end()), HasSubstr("truncated JPEG"));
  EXPECT_EQ(ReadBytes(folder_ / "in/a_truncated.JPG"), truncated);  // the source is as it was
  EXPECT_TRUE(fs::exists(folder_ / "in/b_text.JPG"));
}

TEST_F(ImportCommand, TheSamePhotographAgainAddsNothing) {
  WriteBytes(folder_ / "DSC_0001.JPG", Photo());
  ASSERT_EQ(Import({(folder_ / "DSC_0001.JPG").string()}).exit_code, 0);
  const Ran again = Import({(folder_ / "DSC_0001.JPG").string()});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.Json()["already_there"], 1);
  EXPECT_EQ(Captures().size(), 1U);
}

TEST_F(ImportCommand, WhatCannotBeMeantChangesNothing) {
  WriteBytes(folder_ / "DSC_0001.JPG", Photo());
  const std::string photo = (folder_ / "DSC_0001.JPG").string();
  EXPECT_EQ(Import({photo, "--as", "elbow"}).exit_code, 2);
  EXPECT_EQ(Import({photo, "--laterality", "X"}).exit_code, 2);
  EXPECT_EQ(Import({(folder_ / "nothing.JPG").string()}).exit_code, 1);
  const Ran unknown = Striae({"import", "--session", SomeId<SessionId>(77).ToString(), photo});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("session"));
  EXPECT_TRUE(Captures().empty());
  EXPECT_EQ(Quarantined(), 0U);
}

TEST_F(ImportCommand, TheRealPhotographEntersWithAnHonestVerdict) {
  STRIAE_NEED_DATA("nikon_d90");
  const Ran ran = Import({testing::TestData("nikon_d90/Nikon D90.jpg").string()});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json()["files"][0]["verdict"], "failed");
  ASSERT_EQ(Captures().size(), 1U);
  EXPECT_EQ(Captures()[0].metadata.body_serial, "2188172");
}

TEST_F(CaptureCommand, AShotIsTaggedBeforeTheShutterAndStored) {
  testing::PtpCameraOptions options;
  options.photographs = {Photo(200), Photo(400)};
  const testing::PtpResponder camera(options);
  const Ran ran = CaptureFrom(camera, {"--n", "2", "--as", "wound:W1"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json()["added"], 2) << ran.out;
  EXPECT_THAT(ran.err, HasSubstr("taking photographs of S001"));
  const auto captures = Captures();
  ASSERT_EQ(captures.size(), 2U);
  EXPECT_EQ(captures[1].role.ToString(), "wound:W1");
  EXPECT_EQ(Open().objects().Get(captures[1].sha256).value(), Photo(400));
  EXPECT_EQ(camera.CountOf(0x100B) + camera.CountOf(0x90C3), 0);
}

TEST_F(CaptureCommand, WithoutConsentTheShutterIsNotReleased) {
  ASSERT_TRUE(Open().WithdrawConsent(subject_, {2026, 5, 3}, "asked to stop", stamp_));
  testing::PtpCameraOptions options;
  options.photographs = {Photo()};
  const testing::PtpResponder camera(options);
  const Ran ran = CaptureFrom(camera);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("consent"));
  EXPECT_TRUE(camera.Journal().empty());
}

TEST_F(CaptureCommand, ARefusedShotLeavesTheRecordAsItWas) {
  testing::PtpCameraOptions options;
  options.photographs = {Photo()};
  options.fault = PtpFault::kOutOfFocus;
  const testing::PtpResponder camera(options);
  const Ran ran = CaptureFrom(camera);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("out of focus"));
  EXPECT_EQ(ran.Json()["error"]["code"], "device-failed") << ran.out;
  EXPECT_TRUE(Captures().empty());
}

TEST_F(CaptureCommand, WhatTheCameraTookByItselfIsQuarantined) {
  testing::PtpCameraOptions options;
  options.photographs = {Photo(200), Photo(400)};
  options.fault = PtpFault::kShutterByHand;
  const testing::PtpResponder camera(options);
  const Ran ran = CaptureFrom(camera);
  EXPECT_EQ(ran.exit_code, 1);  // somebody must look at it
  ASSERT_EQ(Captures().size(), 1U);
  EXPECT_EQ(Open().objects().Get(Captures()[0].sha256).value(), Photo(400));
  EXPECT_EQ(Quarantined(), 1U);
}

TEST_F(CaptureCommand, ACorruptTransferIsQuarantined) {
  testing::PtpCameraOptions options;
  options.photographs = {Photo()};
  options.fault = PtpFault::kCorrupt;
  const testing::PtpResponder camera(options);
  const Ran ran = CaptureFrom(camera);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_TRUE(Captures().empty());
  EXPECT_EQ(Quarantined(), 1U);
}

}  // namespace
}  // namespace striae
