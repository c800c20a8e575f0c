// A measured quantity as store, report and DICOM know it: coded, with unit, standard uncertainty, status and origin.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/provenance.h"
#include "core/result.h"

namespace striae {

/// A coded concept (scheme designator, value, meaning), e.g. {"SCT", "118565006", "Volume"}.
struct Code {
  std::string scheme, value, meaning;
  bool operator==(const Code&) const = default;
};

struct Measurement {
  enum class Status { kOk, kFlagged };
  std::string name;               ///< local name, e.g. "volume" (CONTRACT)
  Code code;                      ///< the quantity
  std::vector<Code> equivalents;  ///< same meaning in other schemes
  double value = 0;               ///< finite always
  std::string unit;               ///< UCUM: "mL", "cm2", "mm", "deg"
  double uncertainty = 0;         ///< standard uncertainty (k = 1), same unit, finite, >= 0
  Status status = Status::kOk;
  std::string reason;  ///< why it is flagged; empty when ok
};

/// What one analysis says about its inputs. A refusal is an Error instead, never an empty report.
struct AnalysisReport {
  std::string analysis;  ///< "wound", "head"
  std::string version;   ///< of the analysis' method
  Provenance provenance;
  std::vector<Measurement> measurements;
  nlohmann::json details = nlohmann::json::object();  ///< merged at the top level of the JSON (rotation_matrix, ...)

  /// The measurement of that name, or nullptr.
  [[nodiscard]] const Measurement* Find(std::string_view name) const;
};

/// Flags every measurement for a reason that concerns what it was measured on.
void FlagAll(AnalysisReport& report, const std::string& reason);

nlohmann::json ToJson(const Measurement& measurement);
/// CONTRACT: {"analysis", "version", "inputs": [{"name", "sha256"}], "measurements": [...], ...details}.
nlohmann::json ToJson(const AnalysisReport& report);
/// kBadFile where a field is missing or a value or uncertainty is not finite.
Result<Measurement> MeasurementFromJson(const nlohmann::json& json);
Result<AnalysisReport> AnalysisReportFromJson(const nlohmann::json& json);

}  // namespace striae
