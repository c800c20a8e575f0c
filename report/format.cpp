#include "report/format.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace striae::report {
namespace {

constexpr int kMaxDecimals = 6;
constexpr std::string_view kMinus = "\u2212";
constexpr int kDecimalsWithoutUncertainty = 3;

std::string Magnitude(double value, int decimals) {
  char text[400];  // the largest double has 309 digits before the point
  if (decimals < 0) {
    const double step = std::pow(10.0, -decimals);
    value = std::round(value / step) * step;
    decimals = 0;
  }
  std::snprintf(text, sizeof text, "%.*f", decimals, std::abs(value));
  return text;
}

bool IsZero(const std::string& digits) { return digits.find_first_not_of("0.") == std::string::npos; }

}  // namespace

int DecimalsFor(double uncertainty) {
  if (!(uncertainty > 0)) return kDecimalsWithoutUncertainty;
  int decimals = 1 - static_cast<int>(std::floor(std::log10(uncertainty)));
  // 0.0996 with three decimals would read 0.100: one digit too many after rounding up.
  if (std::round(uncertainty * std::pow(10.0, decimals)) >= 100) --decimals;
  return std::min(decimals, kMaxDecimals);
}

std::string FormatNumber(double value, int decimals) {
  std::string digits = Magnitude(value, decimals);
  return value < 0 && !IsZero(digits) ? std::string(kMinus) + digits : digits;
}

std::string FormatSigned(double value, int decimals) {
  std::string digits = Magnitude(value, decimals);
  if (IsZero(digits)) return digits;
  return (value < 0 ? std::string(kMinus) : std::string("+")) + digits;
}

std::string FormatWithUncertainty(double value, double uncertainty) {
  const int decimals = DecimalsFor(uncertainty);
  if (!(uncertainty > 0)) return FormatNumber(value, decimals) + " (uncertainty not known)";
  return FormatNumber(value, decimals) + " ± " + FormatNumber(uncertainty, decimals);
}

std::string FormatPercent(double percent) { return FormatSigned(percent, 0) + "\u00a0%"; }

std::string UnitText(std::string_view ucum) {
  if (ucum == "cm2") return "cm²";
  if (ucum == "mm2") return "mm²";
  if (ucum == "mm3") return "mm³";
  if (ucum == "1") return "";
  return std::string(ucum);
}

std::string MinuteText(std::string_view iso_utc) {
  if (iso_utc.size() < 16) return std::string(iso_utc);
  return std::string(iso_utc.substr(0, 10)) + " " + std::string(iso_utc.substr(11, 5)) + " UTC";
}

}  // namespace striae::report
