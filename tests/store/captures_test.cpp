// What may enter the record as a photograph, and that it comes out byte for byte.
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

TEST(Captures, NeedConsent) {
  SmallStudy study;
  const Subject subject = study.Enrol("S001");
  const Session session = study.Open(subject);
  const auto refused = FailsWith(ErrorCode::kRecordRefused, "striae consent S001 --given");
  EXPECT_THAT(study->MayCapture(session.id), refused);
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp()), refused);
  EXPECT_FALSE(study->objects().Has(store::HashOf(Bytes("photo")))) << "a refused photograph is not kept";
  ASSERT_THAT(study->GiveConsent(subject.id, {2026, 5, 1}, NextStamp()), IsOk());
  EXPECT_THAT(study->MayCapture(session.id), IsOk());
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp()), IsOk());
}

TEST(Captures, StopWhenConsentIsWithdrawnAndStayReadable) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  const Session session = study.Open(subject);
  const Capture before = study.Import(session, "photo");
  ASSERT_THAT(study->WithdrawConsent(subject.id, {2026, 5, 9}, "", NextStamp()), IsOk());
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), Bytes("another"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "withdrew consent on 2026-05-09"));
  EXPECT_THAT(study->objects().Get(before.sha256), IsOk());
}

/// Consent holds on the days between its entries, however late the photographs of a day are imported.
TEST(Captures, AreOfDaysWithConsentOnly) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");  // 2026-05-01
  const auto on = [&](int day) {
    Session session = study.Open(subject);
    session.id = CountedId<SessionId>();
    session.day = Date{2026, day < 30 ? 5 : 4, day};
    return *study->OpenSession(session, "V1", CountedId<VisitId>(), NextStamp());
  };
  const auto taken = [&](const Session& session) {
    return study->AddCapture(SmallStudy::Photograph(session), Bytes("photo of " + session.day->ToString()),
                             NextStamp());
  };
  EXPECT_THAT(taken(on(30)), FailsWith(ErrorCode::kRecordRefused, "had no consent on 2026-04-30"));
  EXPECT_THAT(taken(on(1)), IsOk()) << "the day itself counts";
  ASSERT_THAT(study->WithdrawConsent(subject.id, {2026, 5, 9}, "", NextStamp()), IsOk());
  ASSERT_THAT(study->GiveConsent(subject.id, {2026, 5, 20}, NextStamp()), IsOk());
  EXPECT_THAT(taken(on(8)), IsOk());
  EXPECT_THAT(taken(on(12)), FailsWith(ErrorCode::kRecordRefused, "had no consent on 2026-05-12"));
  EXPECT_THAT(taken(on(21)), IsOk());
}

TEST(Captures, NeedAnOpenSessionOfThisStudy) {
  SmallStudy study;
  Session session = study.Open(study.EnrolWithConsent("S001"));
  ASSERT_THAT(study->CloseSession(session.id, NextStamp()), IsOk());
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "session open"));
  session.id = CountedId<SessionId>();
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no session"));
}

TEST(Captures, AreNotEmpty) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session), {}, NextStamp()),
              FailsWith(ErrorCode::kBadImage, "empty"));
}

TEST(Captures, KeepEveryFieldAndEveryByte) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  Capture capture = SmallStudy::Photograph(session, "wound:left heel");
  capture.body_site = "calf";
  capture.laterality = Laterality::kLeft;
  capture.metadata.make = "NIKON CORPORATION";
  capture.metadata.body_serial = "6123456";
  capture.metadata.exposure_s = 1.0 / 200;
  capture.metadata.f_number = 11;
  capture.metadata.focus_distance_m = 1.0;
  capture.metadata.iso = 400;
  capture.metadata.orientation = 1;
  capture.metadata.shutter_count = 10321;
  capture.metadata.flash_fired = true;
  capture.metadata.taken_at_camera_clock = "2026:05:04 07:08:09.12";
  capture.metadata.width_px = 4288;
  capture.metadata.height_px = 2848;
  capture.metadata.user_comment = "caf\xE9";  // Latin-1, as cameras write
  capture.preflight = {{"exposure time", PreflightItem::State::kOk, "1/200 s", "1/200 s", ""},
                       {"flash", PreflightItem::State::kFailed, "not fired", "fired", "Switch the flash on"}};
  const std::string photograph("\xFF\xD8 a photograph \0 with zero bytes", 30);
  const store::Stamp stamp = NextStamp();
  ASSERT_THAT(study->AddCapture(capture, Bytes(photograph), stamp), IsOk());
  study.Reopen();
  const auto kept = study->CaptureById(capture.id);
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->session, session.id);
  EXPECT_EQ(kept->sha256, store::HashOf(Bytes(photograph)));
  EXPECT_EQ(kept->size_bytes, photograph.size());
  EXPECT_EQ(kept->imported_at, stamp.now);
  EXPECT_EQ(kept->file_name, capture.file_name);
  EXPECT_EQ(kept->media_type, capture.media_type);
  EXPECT_EQ(kept->role, capture.role);
  EXPECT_EQ(kept->body_site, "calf");
  EXPECT_EQ(kept->laterality, Laterality::kLeft);
  EXPECT_EQ(kept->metadata.make, capture.metadata.make);
  EXPECT_EQ(kept->metadata.body_serial, capture.metadata.body_serial);
  EXPECT_EQ(kept->metadata.exposure_s, capture.metadata.exposure_s);
  EXPECT_EQ(kept->metadata.f_number, capture.metadata.f_number);
  EXPECT_EQ(kept->metadata.focal_length_mm, std::nullopt);
  EXPECT_EQ(kept->metadata.iso, capture.metadata.iso);
  EXPECT_EQ(kept->metadata.shutter_count, capture.metadata.shutter_count);
  EXPECT_EQ(kept->metadata.flash_fired, true);
  EXPECT_EQ(kept->metadata.taken_at_camera_clock, capture.metadata.taken_at_camera_clock);
  EXPECT_EQ(kept->metadata.width_px, 4288);
  EXPECT_EQ(kept->metadata.user_comment, "caf\xEF\xBF\xBD");
  ASSERT_EQ(kept->preflight.size(), 2U);
  EXPECT_EQ(kept->preflight[1].state, PreflightItem::State::kFailed);
  EXPECT_EQ(kept->preflight[1].advice, "Switch the flash on");
  const auto bytes = study->objects().Get(kept->sha256);
  ASSERT_THAT(bytes, IsOk());
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), photograph);
}

TEST(Captures, TheSamePhotographTwiceInASessionIsThereAlready) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture first = study.Import(session, "photo");
  const auto head = study->Head()->sequence;
  const auto again = study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp());
  ASSERT_THAT(again, IsOk());
  EXPECT_TRUE(again->already_there);
  EXPECT_EQ(again->capture.id, first.id);
  EXPECT_EQ(study->Captures(session.id)->size(), 1U);
  EXPECT_EQ(study->Head()->sequence, head);
}

TEST(Captures, ASecondImportSetsAMissingRoleAndNeverChangesOne) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture first = study.Import(session, "photo", "unassigned");
  study.Import(session, "photo", "neutral");
  EXPECT_EQ(study->CaptureById(first.id)->role.ToString(), "neutral");
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(session, "pose"), Bytes("photo"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "as neutral, not as pose"));
  EXPECT_EQ(study->CaptureById(first.id)->role.ToString(), "neutral");
  EXPECT_THAT(study->SetRole(first.id, *CaptureRole::Parse("pose"), "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "reason"));
  EXPECT_THAT(study->SetRole(first.id, *CaptureRole::Parse("pose"), "entered wrongly", NextStamp()), IsOk());
  EXPECT_EQ(study->CaptureById(first.id)->role.ToString(), "pose");
}

TEST(Captures, TheSamePhotographUnderTwoSubjectsIsRefusedAndTheFirstPlaceNamed) {
  SmallStudy study;
  const Session first = study.Open(study.EnrolWithConsent("S001"), "V3");
  const Session second = study.Open(study.EnrolWithConsent("S002"));
  for (const char* role : {"wound:W1", "neutral"}) {
    const std::string photo = std::string("photo of a ") + role;
    study.Import(first, photo, role);
    const auto refused = study->AddCapture(SmallStudy::Photograph(second, role), Bytes(photo), NextStamp());
    EXPECT_THAT(refused,
                FailsWith(ErrorCode::kRecordRefused, "subject S001, visit V3, session " + first.id.ToString()));
  }
  EXPECT_EQ(study->Captures(second.id)->size(), 0U);
}

TEST(Captures, OnlyANeutralPoseServesSeveralSessionsOfItsSubject) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  const Session first = study.Open(subject, "V1"), second = study.Open(subject, "V2");
  study.Import(first, "wound photo", "wound:W1");
  EXPECT_THAT(study->AddCapture(SmallStudy::Photograph(second), Bytes("wound photo"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "visit V1"));
  const Capture neutral = study.Import(first, "neutral photo", "neutral");
  study.Import(second, "neutral photo", "neutral");
  EXPECT_EQ(study->CapturesOf(neutral.sha256)->size(), 2U);
}

TEST(Captures, APhotographThatWasLostComesBackWhenItIsImportedAgain) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "photo");
  std::filesystem::remove(study->objects().PathOf(capture.sha256));
  EXPECT_FALSE(study->Check()->Passed());
  study.Import(session, "photo");
  EXPECT_TRUE(study->Check()->Passed());
}

}  // namespace
}  // namespace striae::testing
