// What a set of measurements must fulfil before it becomes a DICOM report: rules that the usual validators do not know
// (a volume in degrees, a number without its photograph).
#pragma once

#include <string_view>
#include <vector>

#include "core/measurement.h"
#include "core/result.h"
#include "dicom/object.h"

namespace striae::dicom {

enum class Dimension { kLength, kArea, kVolume, kAngle, kNone };

/// The dimension of a UCUM unit; kBadFile for a unit that Striae does not export.
Result<Dimension> DimensionOfUnit(std::string_view unit);
/// UCUM's words for a unit ("square centimeter").
Result<std::string_view> MeaningOfUnit(std::string_view unit);

/// kMeasurementRefused with the measurement and the reason: no measurements; value or uncertainty not finite or
/// uncertainty negative; a code without scheme, value (at most 16 characters) or meaning (64); a unit that does not
/// fit the quantity, by its code and by its name; flagged without a reason; no version; no photograph in the evidence,
/// a wound without its surface, or evidence without its UIDs.
Status CheckReport(const AnalysisReport& report, const std::vector<ObjectReference>& evidence);

}  // namespace striae::dicom
