// Devices, and which calibration counts on which day.
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

const std::string kCalibration = R"({"format": "striae-calibration/1", "image_size": [4288, 2848],
  "camera": {"fx": 9100, "fy": 9100, "cx": 2144, "cy": 1424, "k1": 0, "k2": 0, "p1": 0, "p2": 0},
  "projector": {"model": "pinhole", "center_mm": [0, -150, 0], "rotation_rodrigues": [0.1, 0, 0], "focal_stripes": 1040,
  "center_order": 70, "k1": 0}, "grating": {"stripes": 140, "direction": "horizontal"},
  "working_distance_mm": [800, 1200]})";

Device AddDevice(SmallStudy& study, const std::string& serial, RigRange range) {
  const Device device{CountedId<DeviceId>(), serial, range, "NIKON D90", "50 mm"};
  EXPECT_THAT(study->AddDevice(device, NextStamp()), IsOk());
  return device;
}

TEST(Devices, AreFoundBySerialAndRange) {
  SmallStudy study;
  const Device small = AddDevice(study, "6123456", RigRange::kSmall);
  study.Reopen();
  const auto kept = study->DeviceBySerial("6123456");
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->id, small.id);
  EXPECT_EQ(kept->range, RigRange::kSmall);
  EXPECT_EQ(kept->model, "NIKON D90");
  EXPECT_EQ(kept->lens, "50 mm");
  const Device large = AddDevice(study, "6123456", RigRange::kLarge);
  EXPECT_THAT(study->DeviceBySerial("6123456"), FailsWith(ErrorCode::kUsage, "--range"));
  EXPECT_EQ(study->DeviceBySerial("6123456", RigRange::kLarge)->id, large.id);
  EXPECT_THAT(study->DeviceBySerial("999"), FailsWith(ErrorCode::kNotFound, "device add"));
  EXPECT_THAT(study->AddDevice(small, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "already"));
  EXPECT_THAT(study->AddDevice({CountedId<DeviceId>(), "", RigRange::kSmall, "", ""}, NextStamp()),
              FailsWith(ErrorCode::kUsage, "serial"));
}

TEST(Calibrations, TheNewestThatIsValidOnTheDayCounts) {
  SmallStudy study;
  const Device device = AddDevice(study, "6123456", RigRange::kSmall);
  const auto add = [&](const std::string& text, Date from) {
    return study->AddCalibration(CountedId<CalibrationId>(), device.id, Bytes(text), from, NextStamp());
  };
  const auto june = add(kCalibration + "\n", {2026, 6, 1});
  const auto may = add(kCalibration, {2026, 5, 1});
  const auto june_again = add(kCalibration + "\n\n", {2026, 6, 1});
  ASSERT_THAT(june_again, IsOk());
  EXPECT_THAT(study->CalibrationOn(device.id, {2026, 4, 30}), FailsWith(ErrorCode::kRecordRefused, "calibration add"));
  EXPECT_EQ(study->CalibrationOn(device.id, {2026, 5, 1})->id, may->id);
  EXPECT_EQ(study->CalibrationOn(device.id, {2026, 5, 31})->id, may->id);
  EXPECT_EQ(study->CalibrationOn(device.id, {2026, 6, 1})->id, june_again->id) << "of one day the one added last";
  EXPECT_EQ(study->Calibrations(device.id)->size(), 3U);
  EXPECT_EQ(add(kCalibration, {2026, 5, 1})->id, may->id) << "the same entry twice is one";
  const auto bytes = study->objects().Get(may->sha256);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), kCalibration);
}

TEST(Calibrations, AreReadBeforeTheyAreKept) {
  SmallStudy study;
  const Device device = AddDevice(study, "6123456", RigRange::kSmall);
  EXPECT_THAT(study->AddCalibration(CountedId<CalibrationId>(), device.id, Bytes("{}"), {2026, 5, 1}, NextStamp()),
              FailsWith(ErrorCode::kBadCalibration, ""));
  EXPECT_THAT(study->AddCalibration(CountedId<CalibrationId>(), CountedId<DeviceId>(), Bytes(kCalibration),
                                    {2026, 5, 1}, NextStamp()),
              FailsWith(ErrorCode::kNotFound, "device"));
  EXPECT_TRUE(study->objects().List()->objects.empty());
}

/// What Work() says about one imported photograph.
store::WorkItem OnlyItem(SmallStudy& study, const std::string& role, const std::string& body_serial) {
  const Session session = study.Open(study.EnrolWithConsent("S" + std::to_string(study->Subjects()->size())));
  Capture capture = SmallStudy::Photograph(session, role);
  capture.metadata.body_serial = body_serial;
  EXPECT_THAT(study->AddCapture(capture, Bytes("photo in " + session.id.ToString()), NextStamp()), IsOk());
  return study->Work(session.id)->front();
}

TEST(Work, KnowsDeviceAndCalibrationOfAPhotograph) {
  SmallStudy study;
  EXPECT_NE(OnlyItem(study, "neutral", "").missing.find("device add"), std::string::npos);
  const Device small = AddDevice(study, "111", RigRange::kSmall);
  store::WorkItem item = OnlyItem(study, "wound:W1", "111");
  EXPECT_EQ(item.device->id, small.id);
  EXPECT_EQ(item.calibration, std::nullopt);
  EXPECT_NE(item.missing.find("no calibration valid on"), std::string::npos);
  const auto calibration =
      study->AddCalibration(CountedId<CalibrationId>(), small.id, Bytes(kCalibration), {2026, 5, 1}, NextStamp());
  const Device large = AddDevice(study, "222", RigRange::kLarge);
  item = OnlyItem(study, "wound:W1", "");
  EXPECT_EQ(item.device->id, small.id) << "without a body serial a wound was taken with the one small rig";
  EXPECT_EQ(item.calibration->id, calibration->id);
  EXPECT_EQ(item.missing, "");
  EXPECT_EQ(OnlyItem(study, "pose", "").device->id, large.id);
  EXPECT_EQ(OnlyItem(study, "wound:W1", "222").device->id, large.id) << "the body serial decides where there is one";
  item = OnlyItem(study, "wound:W1", "333");
  EXPECT_EQ(item.device, std::nullopt);
  EXPECT_NE(item.missing.find("body 333"), std::string::npos);
  AddDevice(study, "444", RigRange::kSmall);
  item = OnlyItem(study, "wound:W2", "");
  EXPECT_EQ(item.device, std::nullopt);
  EXPECT_NE(item.missing.find("several devices"), std::string::npos);
}

}  // namespace
}  // namespace striae::testing
