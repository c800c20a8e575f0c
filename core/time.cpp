#include "core/time.h"

#include <chrono>
#include <cstdio>

namespace striae {
namespace {

using std::chrono::day;
using std::chrono::month;
using std::chrono::sys_days;
using std::chrono::year;
using std::chrono::year_month_day;

constexpr std::int64_t kDayMs = 86'400'000;

bool ReadDigits(std::string_view text, std::size_t at, std::size_t count, int& value) {
  if (at + count > text.size()) return false;
  value = 0;
  for (std::size_t i = at; i < at + count; ++i) {
    if (text[i] < '0' || text[i] > '9') return false;
    value = 10 * value + (text[i] - '0');
  }
  return true;
}

year_month_day Civil(const Date& date) {
  return {year(date.year), month(static_cast<unsigned>(date.month)), day(static_cast<unsigned>(date.day))};
}

std::int64_t DaysOf(const Date& date) { return sys_days(Civil(date)).time_since_epoch().count(); }

std::int64_t FloorDays(std::int64_t unix_ms) { return (unix_ms >= 0 ? unix_ms : unix_ms - kDayMs + 1) / kDayMs; }

}  // namespace

Result<Date> Date::Parse(std::string_view text) {
  Date date;
  const bool shaped = text.size() == 10 && text[4] == '-' && text[7] == '-' && ReadDigits(text, 0, 4, date.year) &&
                      ReadDigits(text, 5, 2, date.month) && ReadDigits(text, 8, 2, date.day);
  if (!shaped || !Civil(date).ok()) {
    return Fail(ErrorCode::kUsage, "'" + std::string(text.substr(0, 40)) + "' is not a date; write it as 2026-05-04");
  }
  return date;
}

std::string Date::ToString() const {
  char text[16];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d", year, month, day);
  return text;
}

std::int64_t Date::DaysSinceEpoch() const { return DaysOf(*this); }

Date Date::Of(UtcTime time) {
  const year_month_day civil{sys_days(std::chrono::days(FloorDays(time.unix_ms)))};
  return {static_cast<int>(civil.year()), static_cast<int>(static_cast<unsigned>(civil.month())),
          static_cast<int>(static_cast<unsigned>(civil.day()))};
}

std::string UtcTime::ToString() const {
  const std::int64_t ms = unix_ms - FloorDays(unix_ms) * kDayMs;
  char text[32];
  std::snprintf(text, sizeof text, "T%02d:%02d:%02d.%03dZ", static_cast<int>(ms / 3'600'000),
                static_cast<int>(ms / 60'000 % 60), static_cast<int>(ms / 1000 % 60), static_cast<int>(ms % 1000));
  return Date::Of(*this).ToString() + text;
}

Result<UtcTime> UtcTime::Parse(std::string_view text) {
  const auto bad = [&] {
    return Fail(ErrorCode::kUsage,
                "'" + std::string(text.substr(0, 40)) + "' is not a UTC time; write it as 2026-05-04T07:08:09Z");
  };
  if (text.size() < 20 || text[10] != 'T' || text.back() != 'Z' || text[13] != ':' || text[16] != ':') return bad();
  const auto date = Date::Parse(text.substr(0, 10));
  int hour = 0, minute = 0, second = 0, milli = 0;
  if (!date || !ReadDigits(text, 11, 2, hour) || !ReadDigits(text, 14, 2, minute) || !ReadDigits(text, 17, 2, second)) {
    return bad();
  }
  if (hour > 23 || minute > 59 || second > 59) return bad();
  if (text.size() != 20 && !(text.size() == 24 && text[19] == '.' && ReadDigits(text, 20, 3, milli))) return bad();
  return UtcTime{date->DaysSinceEpoch() * kDayMs + hour * 3'600'000LL + minute * 60'000LL + second * 1000LL + milli};
}

}  // namespace striae
