// Checks of devices in the record, and which captures a failed one puts in doubt.
#include "store/device_checks.h"

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::AddDeviceCheck;
using store::DeviceCheck;
using store::DeviceChecks;
using store::DoubtAt;

UtcTime Noon(int day) {
  return *UtcTime::Parse("2026-04-" + std::string(day < 10 ? "0" : "") + std::to_string(day) + "T12:00:00.000Z");
}

DeviceCheck CheckAt(const UtcTime& time, bool passed, const std::string& kind = "plane") {
  DeviceCheck check;
  check.id = CountedId<store::DeviceCheckId>();
  check.kind = kind;
  check.from = check.until = time;
  check.passed = passed;
  check.evidence.bytes[0] = check.id.uuid().bytes[0];
  check.result = {{"flatness_mm", passed ? 0.3 : 1.7}};
  return check;
}

/// A check of which only the day is known.
DeviceCheck CheckOnDay(int day, bool passed) {
  DeviceCheck check = CheckAt(Noon(day), passed);
  check.from.unix_ms -= 12 * 3'600'000;
  check.until.unix_ms += 12 * 3'600'000 - 1;
  return check;
}

Device AddDevice(SmallStudy& study) {
  const Device device{CountedId<DeviceId>(), "6123456", RigRange::kSmall, "NIKON D90", "50 mm"};
  EXPECT_THAT(study->AddDevice(device, NextStamp()), IsOk());
  return device;
}

TEST(DeviceChecks, AreKeptWithTheirTrail) {
  SmallStudy study;
  const Device device = AddDevice(study);
  DeviceCheck check = CheckAt(Noon(3), true);
  check.device = device.id;
  const auto kept = AddDeviceCheck(study.record(), check, NextStamp());
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->by, "coordinator");
  DeviceCheck earlier = CheckAt(Noon(1), false, "ball");
  earlier.device = device.id;
  ASSERT_THAT(AddDeviceCheck(study.record(), earlier, NextStamp()), IsOk());
  study.Reopen();
  const auto all = DeviceChecks(study.record(), device.id);
  ASSERT_THAT(all, IsOk());
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->at(0).kind, "ball") << "by the time of the check";
  EXPECT_EQ(all->at(1).result, check.result);
  EXPECT_EQ(all->at(1).evidence, check.evidence);
  EXPECT_TRUE(all->at(1).passed);
  EXPECT_EQ(study->History(check.id.ToString())->size(), 1U);
  EXPECT_TRUE(study->Check()->Passed());
  EXPECT_NE(RawSql(study.database(), "UPDATE device_check SET passed = 1"), "");
  EXPECT_NE(RawSql(study.database(), "DELETE FROM device_check"), "");
}

TEST(DeviceChecks, RecordedTwiceAreOne) {
  SmallStudy study;
  DeviceCheck check = CheckAt(Noon(3), true);
  check.device = AddDevice(study).id;
  const auto first = AddDeviceCheck(study.record(), check, NextStamp());
  check.id = CountedId<store::DeviceCheckId>();
  const auto second = AddDeviceCheck(study.record(), check, NextStamp());
  EXPECT_EQ(first->id, second->id);
  EXPECT_EQ(DeviceChecks(study.record(), check.device)->size(), 1U);
}

TEST(DeviceChecks, RefuseWhatCannotBe) {
  SmallStudy study;
  const Device device = AddDevice(study);
  DeviceCheck check = CheckAt(Noon(3), true);
  check.device = CountedId<DeviceId>();
  EXPECT_THAT(AddDeviceCheck(study.record(), check, NextStamp()), FailsWith(ErrorCode::kNotFound, "device"));
  check.device = device.id;
  check.kind = "cube";
  EXPECT_THAT(AddDeviceCheck(study.record(), check, NextStamp()), FailsWith(ErrorCode::kUsage, "cube"));
  check.kind = "plane";
  check.from.unix_ms += 1;
  EXPECT_THAT(AddDeviceCheck(study.record(), check, NextStamp()), FailsWith(ErrorCode::kUsage, "end"));
  check.from = check.until = *UtcTime::Parse("2031-01-01T00:00:00.000Z");
  EXPECT_THAT(AddDeviceCheck(study.record(), check, NextStamp()), FailsWith(ErrorCode::kUsage, "future"));
  EXPECT_TRUE(DeviceChecks(study.record(), device.id)->empty());
}

TEST(Doubt, ReachesFromTheLastPassedCheckToTheNextPassedOne) {
  const std::vector<DeviceCheck> checks = {CheckAt(Noon(2), true), CheckAt(Noon(10), false), CheckAt(Noon(12), false),
                                           CheckAt(Noon(20), true)};
  EXPECT_FALSE(DoubtAt(checks, Noon(1)));
  EXPECT_FALSE(DoubtAt(checks, Noon(2)));
  ASSERT_TRUE(DoubtAt(checks, Noon(5)));
  EXPECT_THAT(DoubtAt(checks, Noon(5))->reason, ::testing::HasSubstr("taken before the check"));
  EXPECT_THAT(DoubtAt(checks, Noon(5))->reason, ::testing::HasSubstr("2026-04-02"));
  ASSERT_TRUE(DoubtAt(checks, Noon(15)));
  EXPECT_THAT(DoubtAt(checks, Noon(15))->reason, ::testing::HasSubstr("taken after the check"));
  EXPECT_EQ(DoubtAt(checks, Noon(15))->check, checks[2].id) << "the newest failure";
  EXPECT_EQ(DoubtAt(checks, Noon(15))->evidence, checks[2].evidence);
  EXPECT_FALSE(DoubtAt(checks, Noon(20)));
  EXPECT_FALSE(DoubtAt(checks, Noon(25)));
}

TEST(Doubt, HasNoBeginningWithoutAPassedCheckAndNoEndWithoutOne) {
  const std::vector<DeviceCheck> checks = {CheckAt(Noon(10), false)};
  EXPECT_TRUE(DoubtAt(checks, Noon(1)));
  EXPECT_TRUE(DoubtAt(checks, Noon(28)));
  EXPECT_FALSE(DoubtAt({}, Noon(1)));
  EXPECT_FALSE(DoubtAt({CheckAt(Noon(10), true)}, Noon(1))) << "a passed check puts nothing in doubt";
}

TEST(Doubt, IsLiftedOnlyByTheKindOfCheckThatFailed) {
  const std::vector<DeviceCheck> checks = {CheckAt(Noon(2), true, "ball"), CheckAt(Noon(10), false, "ball"),
                                           CheckAt(Noon(12), true, "plane")};
  EXPECT_TRUE(DoubtAt(checks, Noon(15)));
}

TEST(Doubt, TakesTheWholeDayOfAFailureOfWhichOnlyTheDayIsKnown) {
  const std::vector<DeviceCheck> checks = {CheckOnDay(2, true), CheckOnDay(10, false), CheckOnDay(10, true)};
  EXPECT_FALSE(DoubtAt(checks, Noon(2))) << "the day of the passed check";
  EXPECT_TRUE(DoubtAt(checks, Noon(9)));
  EXPECT_TRUE(DoubtAt(checks, Noon(10)))
      << "passed again on the same day, but nobody knows before or after the capture";
  EXPECT_FALSE(DoubtAt(checks, Noon(11)));
}

}  // namespace
}  // namespace striae::testing
