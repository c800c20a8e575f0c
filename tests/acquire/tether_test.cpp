// The whole cable: the real libgphoto2 in its worker process, and a scripted D90 at the other end.
#include "acquire/tether.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/structure.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/ptp_responder.h"

namespace striae::acquire {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::PtpFault;
using testing::PtpResponder;

testing::PtpCameraOptions CameraWith(PtpFault fault, std::size_t padding = 0) {
  testing::PhotoOptions photo;
  photo.width = 640;
  photo.height = 480;
  photo.padding = padding;
  testing::PtpCameraOptions camera;
  camera.photographs = {testing::MakeJpeg(photo)};
  camera.fault = fault;
  return camera;
}

CaptureBinding Binding() {
  CaptureBinding binding;
  Uuid session;
  session.bytes.fill(7);
  binding.session = SessionId(session);
  binding.role = {CaptureRole::Kind::kWound, "W1"};
  return binding;
}

TetherOptions OptionsFor(const PtpResponder& camera) {
  TetherOptions options;
  options.port = camera.PortName();
  // The responder answers within milliseconds; a second is slow enough for a loaded machine and quick enough to test.
  options.trigger = milliseconds(1000);
  options.announce = milliseconds(1500);
  options.stall = milliseconds(1500);
  return options;
}

/// The card is the safety copy: no delete, in either form, whatever happened.
void ExpectNothingDeleted(const PtpResponder& camera) {
  EXPECT_EQ(camera.CountOf(0x100B), 0) << "DeleteObject";
  EXPECT_EQ(camera.CountOf(0x90C3), 0) << "DelImageSDRAM";
  EXPECT_EQ(camera.CountOf(0x90C0), 0) << "capture to SDRAM, where a lost cable loses the picture";
}

Error FailureOf(PtpFault fault, std::size_t padding = 0) {
  const PtpResponder camera(CameraWith(fault, padding));
  TetherSource source(OptionsFor(camera), Binding(), 1);
  const auto item = source.Next();
  ExpectNothingDeleted(camera);
  if (item) {
    ADD_FAILURE() << "a photograph came although the camera failed";
    return {};
  }
  EXPECT_EQ(item.error().code, ErrorCode::kDeviceFailed);
  const auto after = source.Next();  // the source has ended, cleanly
  EXPECT_TRUE(after && !after->has_value());
  return item.error();
}

TEST(Tether, APhotographArrivesWholeAndBound) {
  auto made = CameraWith(PtpFault::kNone, 1200000);  // over 1 MiB: more than one block
  const auto photo = made.photographs[0];
  const PtpResponder camera(made);
  TetherSource source(OptionsFor(camera), Binding(), 1);
  const auto item = source.Next();
  ASSERT_TRUE(item) << item.error().Describe();
  ASSERT_TRUE(item->has_value());
  EXPECT_EQ((*item)->bytes, photo);
  EXPECT_EQ((*item)->file_name, "DSC_0001.JPG");
  EXPECT_THAT((*item)->origin, HasSubstr("9000001"));
  ASSERT_TRUE((*item)->binding);
  EXPECT_EQ((*item)->binding->session, Binding().session);
  EXPECT_EQ((*item)->binding->role.label, "W1");
  const auto end = source.Next();
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->has_value());  // announced twice by the camera, delivered once
  EXPECT_EQ(camera.CountOf(0x100E), 1);
  EXPECT_GE(camera.CountOf(0x101B), 2);
  ExpectNothingDeleted(camera);
}

TEST(Tether, ThreeShotsAreThreePhotographs) {
  auto made = CameraWith(PtpFault::kNone);
  made.photographs.push_back(made.photographs[0]);
  made.photographs[1].insert(made.photographs[1].end(), 3, 0);
  made.photographs.push_back(made.photographs[0]);
  const PtpResponder camera(made);
  TetherSource source(OptionsFor(camera), Binding(), 3);
  for (std::size_t shot = 0; shot < 3; ++shot) {
    const auto item = source.Next();
    ASSERT_TRUE(item && *item);
    EXPECT_EQ((*item)->bytes, made.photographs[shot]);
    EXPECT_EQ((*item)->file_name, "DSC_000" + std::to_string(shot + 1) + ".JPG");
  }
  EXPECT_EQ(camera.CountOf(0x100E), 3);
  ExpectNothingDeleted(camera);
}

TEST(Tether, ABusyCameraIsAskedAgain) {
  const PtpResponder camera(CameraWith(PtpFault::kBusyTwice));
  TetherSource source(OptionsFor(camera), Binding(), 1);
  const auto item = source.Next();
  ASSERT_TRUE(item) << item.error().Describe();
  EXPECT_TRUE(item->has_value());
  EXPECT_GE(camera.CountOf(0x100E), 3);
}

TEST(Tether, APressOnTheCamerasButtonBelongsToNobody) {
  auto made = CameraWith(PtpFault::kShutterByHand);
  made.photographs.push_back(made.photographs[0]);
  const PtpResponder camera(made);
  TetherSource source(OptionsFor(camera), Binding(), 1);
  int bound = 0, unbound = 0;
  while (true) {
    const auto item = source.Next();
    ASSERT_TRUE(item) << item.error().Describe();
    if (!*item) break;
    ((*item)->binding ? bound : unbound) += 1;
    EXPECT_EQ((*item)->file_name, (*item)->binding ? "DSC_0002.JPG" : "DSC_0001.JPG");
  }
  EXPECT_EQ(bound, 1);
  EXPECT_EQ(unbound, 1);
}

TEST(TetherFailure, NoCameraAtThePort) {
  TetherOptions options;
  int port = 0;
  { port = PtpResponder(CameraWith(PtpFault::kNone)).port(); }  // it was free a moment ago and is again
  options.port = "ptpip:127.0.0.1:" + std::to_string(port) + ":" + std::to_string(port);
  TetherSource source(options, Binding(), 1);
  const auto item = source.Next();
  ASSERT_FALSE(item);
  EXPECT_EQ(item.error().code, ErrorCode::kDeviceFailed);
  EXPECT_THAT(item.error().message, HasSubstr("connection to the camera failed"));
}

TEST(TetherFailure, OutOfFocusIsNamed) {
  EXPECT_THAT(FailureOf(PtpFault::kOutOfFocus).message, HasSubstr("out of focus"));
}

TEST(TetherFailure, AFullCardIsNamed) {
  EXPECT_THAT(FailureOf(PtpFault::kStoreFull).message, HasSubstr("card is full"));
}

TEST(TetherFailure, ACameraThatStaysBusyIsNamed) { EXPECT_THAT(FailureOf(PtpFault::kBusy).message, HasSubstr("busy")); }

TEST(TetherFailure, AShotThatIsNeverAnnouncedMayBeOnTheCard) {
  EXPECT_THAT(FailureOf(PtpFault::kNoEvent).message, HasSubstr("announced no file"));
}

TEST(TetherFailure, AShortTransferIsNoPhotograph) {
  EXPECT_THAT(FailureOf(PtpFault::kTruncated, 2500000).message, HasSubstr("on the card"));
  EXPECT_THAT(FailureOf(PtpFault::kTruncated).message, HasSubstr("on the card"));
}

TEST(TetherFailure, AStalledTransferEndsInTime) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(FailureOf(PtpFault::kStall, 2500000).message, HasSubstr("transfer"));
  // 1.5 s without a block, two seconds at most to connect and drain; libgphoto2 alone would need 20 s or more.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(TetherFailure, ATriggerWithoutAnswerEndsInTime) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(FailureOf(PtpFault::kSilent).message.empty());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(12));
}

TEST(TetherFailure, CorruptBytesOfTheRightSizeAreFoundByTheStructure) {
  const PtpResponder camera(CameraWith(PtpFault::kCorrupt));
  TetherSource source(OptionsFor(camera), Binding(), 1);
  const auto item = source.Next();
  ASSERT_TRUE(item && *item);
  EXPECT_FALSE(CheckStructure((*item)->bytes));
}

TEST(TetherFailure, AMissingWorkerIsAMissingInstallation) {
  TetherOptions options;
  options.worker = "/nonexistent/striae-tether-worker";
  TetherSource source(options, Binding(), 1);
  const auto item = source.Next();
  ASSERT_FALSE(item);
  EXPECT_EQ(item.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace striae::acquire
