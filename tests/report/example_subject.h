// Invented subjects whose numbers are chosen so that the right verdicts can be worked out by hand.
#pragma once

#include <string>

#include "report/subject_report.h"

namespace striae::testing {

/// A wound at V1 (day 0), V2 (day 14), V3 (day 28):
///   area    12.0 ± 0.3 cm2, 10.5 ± 0.3, 7.0 ± 0.3   -> V2 -1.5, limit 1.96 sqrt(0.18) = 0.83: improved; V3 improved
///   volume   4.00 ± 0.20 mL, 3.80 ± 0.20, 1.9 ± 0.20 flagged -> V2 within error (limit 0.55), V3 not assessable
///   depth_max 6.0 ± 0.4 mm, 8.0 ± 0.4, 5.8 ± 0.4   -> V2 worse (+2.0 > 1.11), V3 within error
/// V3 has a second photograph that failed, V4 was missed.
report::SubjectReport WoundSubject();

/// Head poses at V1 and V2: rotation 32 ± 1.5 deg, then 20 ± 1.5: -12 (-37.5 %), limit 4.16: improved.
/// flexion -8 ± 1.5, then -14 ± 1.5: size +6: worse. tilt 1.0 ± 1.5, then 2.0 ± 1.5: within error.
report::SubjectReport HeadSubject();

/// A PNG of one colour.
std::vector<std::uint8_t> PlainPng(int width, int height, unsigned char grey);

Measurement MakeMeasurement(const std::string& name, double value, double uncertainty, const std::string& unit);

}  // namespace striae::testing
