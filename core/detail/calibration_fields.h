// Reading a calibration's JSON field by field: the first thing wrong is kept, so that a reader reads as a list of
// fields.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "core/calibration.h"
#include "core/result.h"

namespace striae::detail {

/// JSON as it is expected in a small file: no key twice in one object, at most `kDeepestNesting` levels. The reason is
/// printable ASCII, whatever the bytes are.
inline constexpr int kDeepestNesting = 8;
Result<nlohmann::json> ParseStrictJson(std::string_view text);

class Fields {
 public:
  explicit Fields(const nlohmann::json& root) : root_(root) {}

  double Number(const std::string& path);
  double NumberOr(const std::string& path, double fallback) { return Has(path) ? Number(path) : fallback; }
  double Positive(const std::string& path);
  /// A number with an absolute value up to `largest`; `fallback` where it is missing.
  double Within(const std::string& path, double largest, double fallback);
  Eigen::Vector3d Vector(const std::string& path, double largest);
  void Require(bool holds, const std::string& what) {
    if (!holds && problem_.empty()) problem_ = what;
  }
  [[nodiscard]] bool Has(const std::string& path) const { return root_.contains(nlohmann::json::json_pointer(path)); }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  const nlohmann::json& root_;
  std::string problem_;
};

/// The optional "uncertainty": {"names": [...], "covariance": [[...], ...]}.
void ReadUncertainty(Fields& fields, const nlohmann::json& root, Calibration& calibration);
nlohmann::json ToJson(const CalibrationUncertainty& uncertainty);

}  // namespace striae::detail
