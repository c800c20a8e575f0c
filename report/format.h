// Numbers as a reader should meet them: no more digits than the uncertainty allows, with the unit in print form.
#pragma once

#include <string>
#include <string_view>

namespace striae::report {

/// Decimals that show an uncertainty with two significant digits; negative when they lie left of the point.
/// 0.0521 -> 3, 12.3 -> 0, 123 -> -1, 0.0996 -> 2 (it is printed as 0.10). At most 6.
int DecimalsFor(double uncertainty);

/// Fixed decimals (rounded to tens, hundreds when negative), a true minus sign, never "-0".
std::string FormatNumber(double value, int decimals);
/// As FormatNumber with a plus sign before positive values.
std::string FormatSigned(double value, int decimals);

/// "0.713 ± 0.052": both with the digits of the uncertainty. With an uncertainty of 0, which no measurement has:
/// "0.713 (uncertainty not known)".
std::string FormatWithUncertainty(double value, double uncertainty);

/// "−37 %", "+4 %", "0 %".
std::string FormatPercent(double percent);

/// UCUM to print: "cm2" -> "cm²"; what is not known stays as it is.
std::string UnitText(std::string_view ucum);

/// "2026-05-04 07:08 UTC"
std::string MinuteText(std::string_view iso_utc);

}  // namespace striae::report
