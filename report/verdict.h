// Is a change larger than the measurements' own error, and is it for the better?
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace striae::report {

enum class Verdict { kImproved, kWorse, kWithinError, kNotAssessable };
/// "improved", "worse", "within error", "not assessable"
std::string_view ToString(Verdict verdict);

/// Which direction is the better one. The last two compare sizes (absolute values), for angles with a side.
enum class Better { kNotDefined, kSmaller, kLarger, kSmallerSize, kLargerSize };

/// One value of a quantity at one visit.
struct Reading {
  double value = 0;
  double uncertainty = 0;  ///< standard uncertainty (k = 1), same unit
  std::string unit;        ///< UCUM
  bool flagged = false;
  std::string method;  ///< analysis and its version: values of two methods are not compared
};

/// A change between two readings.
struct Comparison {
  std::optional<double> change;   ///< now - first (of the sizes for the last two of Better); none without equal units
  double change_uncertainty = 0;  ///< sqrt(u_now^2 + u_first^2)
  double limit = 0;               ///< 1.96 x change_uncertainty
  std::optional<double> percent;  ///< of the first reading; none when that cannot be told from 0 (<= 1.96 u)
  Verdict verdict = Verdict::kNotAssessable;
  std::string reason;  ///< why it is not assessable; empty otherwise
};

/// The limit is the minimal detectable change MDC95 = 1.96 sqrt(2) SEM (Weir, J Strength Cond Res 2005, 19:231) with
/// each reading's own standard uncertainty in the place of the SEM: 1.96 sqrt(u_now^2 + u_first^2), errors taken as
/// independent. |change| <= limit is within error. Not assessable when a reading is flagged or has no uncertainty,
/// unit or method differ, no direction is defined, or an angle has changed its side by more than the limit without
/// its size changing by more.
Comparison Compare(const Reading& first, const Reading& now, Better better);

}  // namespace striae::report
