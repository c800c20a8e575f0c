#include "app/local_time.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <optional>

namespace striae::app {
namespace {

/// The C library computes in the zone that TZ names. The program has one thread where this is used.
class InZone {
 public:
  explicit InZone(const std::string& zone) {
    if (const char* before = std::getenv("TZ")) before_ = before;
    ::setenv("TZ", zone.empty() ? "UTC" : (":" + zone).c_str(), 1);
    ::tzset();
  }
  ~InZone() {
    if (before_) {
      ::setenv("TZ", before_->c_str(), 1);
    } else {
      ::unsetenv("TZ");
    }
    ::tzset();
  }
  InZone(const InZone&) = delete;
  InZone& operator=(const InZone&) = delete;

 private:
  std::optional<std::string> before_;
};

constexpr const char* kZones = "/usr/share/zoneinfo";

/// An unknown zone is silently UTC for the C library.
bool Exists(const std::string& zone) {
  if (zone.empty() || zone == "UTC") return true;
  std::error_code code;
  return zone.find("..") == std::string::npos &&
         std::filesystem::is_regular_file(std::filesystem::path(kZones) / zone, code);
}

}  // namespace

Result<UtcTime> ParseLocal(const std::string& text, const std::string& zone) {
  if (text.ends_with('Z')) return UtcTime::Parse(text);
  const auto date = Date::Parse(text.substr(0, 10));
  if (!date) return Fail(date.error());
  int hour = 12, minute = 0, used = 0;
  if (text.size() > 10 &&
      (std::sscanf(text.c_str() + 10, "T%2d:%2d%n", &hour, &minute, &used) != 2 ||
       used != static_cast<int>(text.size()) - 10 || hour < 0 || hour > 23 || minute < 0 || minute > 59)) {
    return Fail(ErrorCode::kUsage, "'" + text.substr(0, 40) + "' is no time; write 2026-05-04 or 2026-05-04T10:30");
  }
  if (!Exists(zone)) {
    return Fail(ErrorCode::kUsage, "this system does not know the site's time zone '" + zone +
                                       "'; write the time in UTC, with Z at its end: 2026-05-04T08:30:00Z");
  }
  const InZone in_zone(zone);
  std::tm local{};
  local.tm_year = date->year - 1900;
  local.tm_mon = date->month - 1;
  local.tm_mday = date->day;
  local.tm_hour = hour;
  local.tm_min = minute;
  local.tm_isdst = -1;
  return UtcTime{static_cast<std::int64_t>(std::mktime(&local)) * 1000};
}

Date DayAt(UtcTime time, const std::string& zone) {
  const InZone in_zone(Exists(zone) ? zone : "");
  const auto seconds = static_cast<std::time_t>((time.unix_ms - (time.unix_ms % 1000 + 1000) % 1000) / 1000);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return {local.tm_year + 1900, local.tm_mon + 1, local.tm_mday};
}

Status CheckZone(const std::string& zone) {
  std::error_code code;
  if (Exists(zone) || !std::filesystem::is_directory(kZones, code)) return {};
  return Fail(ErrorCode::kUsage, "this system knows no time zone '" + zone.substr(0, 64) +
                                     "'; give --time-zone as in /usr/share/zoneinfo, such as Europe/Ljubljana");
}

}  // namespace striae::app
