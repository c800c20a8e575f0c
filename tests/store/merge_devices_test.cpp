// Devices at two sites: their calibrations, their checks, and the doubts that these cast.
#include "store/device_checks.h"
#include "tests/store/sites.h"

namespace striae::testing {
namespace {

using store::DeviceCheck;

Device Enter(store::Record& record, const std::string& serial) {
  const Device device{CountedId<DeviceId>(), serial, RigRange::kSmall, "NIKON D90", "50 mm"};
  EXPECT_THAT(record.AddDevice(device, NextStamp()), IsOk());
  return device;
}

/// A plane's check on a day of April 2026.
DeviceCheck Checked(store::Record& record, const DeviceId& device, int day, bool passed) {
  DeviceCheck check;
  check.id = CountedId<store::DeviceCheckId>();
  check.device = device;
  check.kind = "plane";
  check.from = check.until =
      *UtcTime::Parse("2026-04-" + std::string(day < 10 ? "0" : "") + std::to_string(day) + "T12:00:00.000Z");
  check.passed = passed;
  check.evidence.bytes[0] = check.id.uuid().bytes[0];
  check.result = {{"flatness_mm", passed ? 0.3 : 1.7}};
  const auto kept = store::AddDeviceCheck(record, check, NextStamp());
  EXPECT_THAT(kept, IsOk());
  return kept ? *kept : check;
}

/// A study that had a device before it was branched.
class DevicesOfTwoSites : public ::testing::Test {
 protected:
  DevicesOfTwoSites() {
    {
      auto a = sites_.Open("a");
      device_ = Enter(a, "6123456");
      Checked(a, device_.id, 1, true);
    }
    sites_.Merge("b", "a");
  }
  Sites sites_;
  Device device_;
};

TEST_F(DevicesOfTwoSites, ChecksOfOneDeviceComeTogetherInTheOrderOfTheirDays) {
  {
    auto a = sites_.Open("a"), b = sites_.Open("b");
    Checked(a, device_.id, 3, true);
    Checked(b, device_.id, 2, false);  // both number it 2
    Checked(b, device_.id, 9, true);
    Checked(a, device_.id, 6, false);
  }
  EXPECT_EQ(sites_.BothWays(), "");
  const auto once = ContentOf(sites_.At("a"));
  sites_.Merge("a", "b");
  EXPECT_EQ(ContentOf(sites_.At("a")), once) << "again is nothing";
  auto merged = sites_.Open("a");
  const auto checks = store::DeviceChecks(merged, device_.id);
  ASSERT_THAT(checks, IsOk());
  ASSERT_EQ(checks->size(), 5U);
  std::string days;
  for (const DeviceCheck& check : *checks)
    days += Date::Of(check.from).ToString().substr(8) + (check.passed ? "+" : "-");
  EXPECT_EQ(days, "01+02-03+06-09+");
  EXPECT_THAT(RawSql(sites_.At("a") / "study.db", "DELETE FROM device_check"), ::testing::HasSubstr("never deleted"));
}

TEST_F(DevicesOfTwoSites, AFailureAtTheOtherSitePutsItsTimeInDoubtHereToo) {
  {
    auto b = sites_.Open("b");
    Checked(b, device_.id, 5, false);
  }
  const UtcTime between = *UtcTime::Parse("2026-04-03T12:00:00.000Z");
  {
    auto a = sites_.Open("a");
    EXPECT_EQ(store::DoubtAt(*store::DeviceChecks(a, device_.id), between), std::nullopt);
  }
  sites_.Merge("a", "b");
  auto a = sites_.Open("a");
  EXPECT_NE(store::DoubtAt(*store::DeviceChecks(a, device_.id), between), std::nullopt);
}

TEST_F(DevicesOfTwoSites, ChecksStayWithADeviceThatWasEnteredTwice) {
  Device at_a, at_b;
  {
    auto a = sites_.Open("a"), b = sites_.Open("b");
    at_a = Enter(a, "777");
    at_b = Enter(b, "777");
    Checked(a, at_a.id, 3, true);
    Checked(b, at_b.id, 3, false);
  }
  EXPECT_EQ(sites_.BothWays(), "");
  auto merged = sites_.Open("a");
  EXPECT_TRUE(store::DeviceChecks(merged, at_a.id)->front().passed);
  EXPECT_FALSE(store::DeviceChecks(merged, at_b.id)->front().passed);
  EXPECT_TRUE(merged.Check()->findings.empty());
}

}  // namespace
}  // namespace striae::testing
