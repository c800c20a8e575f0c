#include "core/time.h"

#include <gmock/gmock.h>

namespace striae {
namespace {

TEST(Date, OnlyDaysThatExist) {
  EXPECT_TRUE(Date::Parse("2028-02-29"));
  for (const char* text : {"2026-02-29", "2026-13-01", "2026-00-10", "26-01-01", "2026/01/01", "2026-1-1", ""}) {
    EXPECT_FALSE(Date::Parse(text)) << text;
  }
}

TEST(Date, StudyDaysAreDifferences) {
  EXPECT_EQ(Date::Parse("2026-03-01")->DaysSinceEpoch() - Date::Parse("2026-02-01")->DaysSinceEpoch(), 28);
  EXPECT_EQ(Date::Parse("1970-01-01")->DaysSinceEpoch(), 0);
}

TEST(UtcTime, PrintsAndParsesToTheMillisecond) {
  for (const char* text : {"2026-05-04T07:08:09.123Z", "1969-12-31T23:59:59.999Z", "1970-01-01T00:00:00.000Z"}) {
    const auto time = UtcTime::Parse(text);
    ASSERT_TRUE(time) << text;
    EXPECT_EQ(time->ToString(), text);
  }
  EXPECT_EQ(UtcTime::Parse("2026-05-04T07:08:09Z")->ToString(), "2026-05-04T07:08:09.000Z");
}

TEST(UtcTime, NeedsItsZone) {
  for (const char* text : {"2026-05-04T07:08:09", "2026-05-04 07:08:09Z", "2026-05-04T25:08:09Z", "2026-05-04"}) {
    EXPECT_FALSE(UtcTime::Parse(text)) << text;
  }
}

}  // namespace
}  // namespace striae
