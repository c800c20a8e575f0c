// Instants and calendar days, as ISO 8601. No clock is read here: the time comes from app/.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"

namespace striae {

/// Milliseconds since 1970-01-01T00:00:00Z.
struct UtcTime {
  std::int64_t unix_ms = 0;
  /// "2026-05-04T07:08:09.123Z"
  [[nodiscard]] std::string ToString() const;
  static Result<UtcTime> Parse(std::string_view text);
  auto operator<=>(const UtcTime&) const = default;
};

/// A day of the Gregorian calendar, without a time zone.
struct Date {
  int year = 0, month = 0, day = 0;
  /// "2026-05-04"
  [[nodiscard]] std::string ToString() const;
  /// kUsage when it is not a day that exists.
  static Result<Date> Parse(std::string_view text);
  /// Days since 1970-01-01; differences are study days.
  [[nodiscard]] std::int64_t DaysSinceEpoch() const;
  /// The UTC day of an instant.
  static Date Of(UtcTime time);
  auto operator<=>(const Date&) const = default;
};

}  // namespace striae
