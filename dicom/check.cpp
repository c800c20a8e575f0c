#include "dicom/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace striae::dicom {
namespace {

struct Unit {
  std::string_view ucum, meaning;
  Dimension dimension;
};

constexpr std::array<Unit, 13> kUnits{{
    {"mm", "millimeter", Dimension::kLength},
    {"cm", "centimeter", Dimension::kLength},
    {"m", "meter", Dimension::kLength},
    {"mm2", "square millimeter", Dimension::kArea},
    {"cm2", "square centimeter", Dimension::kArea},
    {"mm3", "cubic millimeter", Dimension::kVolume},
    {"cm3", "cubic centimeter", Dimension::kVolume},
    {"mL", "milliliter", Dimension::kVolume},
    {"ml", "milliliter", Dimension::kVolume},
    {"deg", "degree", Dimension::kAngle},
    {"rad", "radian", Dimension::kAngle},
    {"%", "percent", Dimension::kNone},
    {"1", "no units", Dimension::kNone},
}};

struct Quantity {
  std::string_view key;
  Dimension dimension;
};

/// Public codes whose dimension is beyond doubt (SNOMED CT, LOINC).
constexpr std::array<Quantity, 11> kCodes{{
    {"118565006", Dimension::kVolume},
    {"94083-3", Dimension::kVolume},
    {"42798000", Dimension::kArea},
    {"89260-4", Dimension::kArea},
    {"131197000", Dimension::kLength},
    {"39127-6", Dimension::kLength},
    {"131191004", Dimension::kLength},
    {"410668003", Dimension::kLength},
    {"39126-8", Dimension::kLength},
    {"39125-0", Dimension::kLength},
    {"103355008", Dimension::kLength},
}};

/// The analyses' own names.
constexpr std::array<Quantity, 14> kNames{{
    {"volume", Dimension::kVolume},
    {"proud_volume", Dimension::kVolume},
    {"area", Dimension::kArea},
    {"bed_area", Dimension::kArea},
    {"perimeter", Dimension::kLength},
    {"depth_max", Dimension::kLength},
    {"depth_p95", Dimension::kLength},
    {"depth_mean", Dimension::kLength},
    {"length", Dimension::kLength},
    {"width", Dimension::kLength},
    {"rotation", Dimension::kAngle},
    {"flexion", Dimension::kAngle},
    {"tilt", Dimension::kAngle},
    {"total_angle", Dimension::kAngle},
}};

template <std::size_t N>
std::optional<Dimension> Look(const std::array<Quantity, N>& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Quantity& row) { return row.key == key; });
  if (found == table.end()) return std::nullopt;
  return found->dimension;
}

Result<Unit> FindUnit(std::string_view ucum) {
  const auto found = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& unit) { return unit.ucum == ucum; });
  if (found != kUnits.end()) return *found;
  return Fail(ErrorCode::kBadFile, "\"" + std::string(ucum) + "\" is not a UCUM unit that a DICOM report takes");
}

Status Refuse(const Measurement& measurement, const std::string& why) {
  return Fail(ErrorCode::kMeasurementRefused,
              "measurement \"" + measurement.name + "\" is not fit for a DICOM report: " + why);
}

Status CheckCode(const Measurement& measurement, const Code& code) {
  if (code.scheme.empty() || code.value.empty() || code.meaning.empty()) {
    return Refuse(measurement, "its code lacks scheme, value or meaning");
  }
  if (code.scheme.size() > 16 || code.value.size() > 16 || code.meaning.size() > 64) {
    return Refuse(measurement, "its code is longer than DICOM allows (16, 16 and 64 characters)");
  }
  return {};
}

Status CheckMeasurement(const Measurement& measurement) {
  if (measurement.name.empty()) return Refuse(measurement, "it has no name");
  if (!std::isfinite(measurement.value)) return Refuse(measurement, "its value is not a finite number");
  if (!std::isfinite(measurement.uncertainty) || measurement.uncertainty < 0) {
    return Refuse(measurement, "its uncertainty is not a finite number of 0 or more");
  }
  if (measurement.status == Measurement::Status::kFlagged && measurement.reason.empty()) {
    return Refuse(measurement, "it is flagged without a reason");
  }
  if (auto code = CheckCode(measurement, measurement.code); !code) return code;
  for (const Code& equivalent : measurement.equivalents) {
    if (auto code = CheckCode(measurement, equivalent); !code) return code;
  }
  const auto unit = DimensionOfUnit(measurement.unit);
  if (!unit) return Refuse(measurement, unit.error().message);
  for (const auto expected : {Look(kCodes, measurement.code.value), Look(kNames, measurement.name)}) {
    if (expected && *expected != *unit) {
      return Refuse(measurement, "unit \"" + measurement.unit + "\" does not fit the quantity " +
                                     measurement.code.meaning + " (" + measurement.code.value + ")");
    }
  }
  return {};
}

Status CheckEvidence(const AnalysisReport& report, const std::vector<ObjectReference>& evidence) {
  const auto has = [&](ObjectKind kind) {
    return std::any_of(evidence.begin(), evidence.end(), [kind](const ObjectReference& e) { return e.kind == kind; });
  };
  if (!has(ObjectKind::kPhoto)) {
    return Fail(ErrorCode::kMeasurementRefused, "the " + report.analysis + " report refers to no photograph");
  }
  if (report.analysis == "wound" && !has(ObjectKind::kSurface)) {
    return Fail(ErrorCode::kMeasurementRefused, "the wound report refers to no surface");
  }
  for (const ObjectReference& object : evidence) {
    if (object.sop_instance_uid.empty() || object.sop_class_uid.empty() || object.series_uid.empty() ||
        object.study_uid.empty()) {
      return Fail(ErrorCode::kMeasurementRefused,
                  "the " + report.analysis + " report refers to an object without UIDs");
    }
  }
  return {};
}

}  // namespace

Result<Dimension> DimensionOfUnit(std::string_view unit) {
  const auto found = FindUnit(unit);
  if (!found) return Fail(found.error());
  return found->dimension;
}

Result<std::string_view> MeaningOfUnit(std::string_view unit) {
  const auto found = FindUnit(unit);
  if (!found) return Fail(found.error());
  return found->meaning;
}

Status CheckReport(const AnalysisReport& report, const std::vector<ObjectReference>& evidence) {
  if (report.measurements.empty()) {
    return Fail(ErrorCode::kMeasurementRefused, "the " + report.analysis + " report has no measurements");
  }
  if (report.analysis.empty() || report.version.empty() || report.provenance.version.empty()) {
    return Fail(ErrorCode::kMeasurementRefused, "the report does not say which analysis and version made it");
  }
  for (const Measurement& measurement : report.measurements) {
    if (auto fit = CheckMeasurement(measurement); !fit) return fit;
  }
  return CheckEvidence(report, evidence);
}

}  // namespace striae::dicom
