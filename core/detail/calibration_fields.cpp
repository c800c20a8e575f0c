#include "core/detail/calibration_fields.h"

#include <cmath>
#include <set>

namespace striae::detail {
namespace {

using nlohmann::json;

constexpr double kLargestNumber = 1e9;
constexpr std::size_t kLargestFile = std::size_t{16} << 20;

std::string Printable(std::string text) {
  for (char& c : text) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return text;
}

}  // namespace

Result<json> ParseStrictJson(std::string_view text) {
  if (text.size() > kLargestFile) return Fail(ErrorCode::kBadFile, "the file is larger than 16 MB");
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  std::string problem;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > kDeepestNesting && problem.empty()) problem = "it is nested too deeply";
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second && problem.empty()) {
      problem = "\"" + parsed.get<std::string>() + "\" stands twice in one object";
    }
    return true;
  };
  try {
    json root = json::parse(text, watch);
    if (!problem.empty()) return Fail(ErrorCode::kBadFile, Printable(problem));
    return root;
  } catch (const json::exception& e) {
    return Fail(ErrorCode::kBadFile, Printable(problem.empty() ? e.what() : problem));
  }
}

double Fields::Number(const std::string& path) {
  const json::json_pointer pointer(path);
  const bool present = root_.contains(pointer);
  if (!present || !root_.at(pointer).is_number()) {
    Require(false, path + (present ? " is not a number" : " is missing"));
    return 0;
  }
  const auto value = root_.at(pointer).get<double>();
  if (std::isfinite(value) && std::abs(value) < kLargestNumber) return value;
  Require(false, path + " is not a sensible number");
  return 0;
}

double Fields::Positive(const std::string& path) {
  const double value = Number(path);
  Require(value > 0, path + " must be positive");
  return value;
}

double Fields::Within(const std::string& path, double largest, double fallback) {
  const double value = NumberOr(path, fallback);
  Require(std::abs(value) <= largest, path + " is not a sensible number");
  return value;
}

Eigen::Vector3d Fields::Vector(const std::string& path, double largest) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const std::string element = path + "/" + std::to_string(i);
    vector[i] = Number(element);
    Require(std::abs(vector[i]) <= largest, element + " is not a sensible number");
  }
  return vector;
}

void ReadUncertainty(Fields& fields, const json& root, Calibration& calibration) {
  if (!root.contains("uncertainty") || root.at("uncertainty").is_null()) return;
  const json& object = root.at("uncertainty");
  CalibrationUncertainty uncertainty;
  uncertainty.names = object.at("names").get<std::vector<std::string>>();
  const std::set<std::string> unique(uncertainty.names.begin(), uncertainty.names.end());
  fields.Require(!unique.empty() && unique.size() == uncertainty.names.size(),
                 "/uncertainty/names is empty or names a parameter twice");
  for (const std::string& name : unique) {
    fields.Require(CalibrationParameter(calibration, name) != nullptr,
                   "/uncertainty/names has a parameter that this model does not have");
  }
  const json& rows = object.at("covariance");
  const auto size = static_cast<Eigen::Index>(uncertainty.names.size());
  const auto sized = [&](const json& list) { return list.is_array() && list.size() == uncertainty.names.size(); };
  fields.Require(sized(rows), "/uncertainty/covariance has not one row for each name");
  if (!fields.problem().empty()) return;
  uncertainty.covariance.resize(size, size);
  for (Eigen::Index row = 0; row < size; ++row) {
    const json& values = rows[static_cast<std::size_t>(row)];
    fields.Require(sized(values), "/uncertainty/covariance is not square");
    if (!fields.problem().empty()) return;
    for (Eigen::Index col = 0; col < size; ++col) {
      uncertainty.covariance(row, col) =
          fields.Number("/uncertainty/covariance/" + std::to_string(row) + "/" + std::to_string(col));
    }
  }
  const Eigen::MatrixXd& c = uncertainty.covariance;
  constexpr double kRounding = 1e-9;  // of the scale that the diagonal gives
  for (Eigen::Index row = 0; row < size; ++row) {
    fields.Require(c(row, row) >= 0, "/uncertainty/covariance has a negative diagonal");
    for (Eigen::Index col = 0; col < row; ++col) {
      const double scale = std::sqrt(std::max(0.0, c(row, row)) * std::max(0.0, c(col, col)));
      fields.Require(std::abs(c(row, col) - c(col, row)) <= kRounding * scale,
                     "/uncertainty/covariance is not symmetric");
      fields.Require(std::abs(c(row, col)) <= (1 + 1e-6) * scale, "/uncertainty/covariance has a correlation beyond 1");
    }
  }
  calibration.uncertainty = std::move(uncertainty);
}

json ToJson(const CalibrationUncertainty& uncertainty) {
  json rows = json::array();
  for (Eigen::Index row = 0; row < uncertainty.covariance.rows(); ++row) {
    json values = json::array();
    for (Eigen::Index col = 0; col < uncertainty.covariance.cols(); ++col) {
      values.push_back(uncertainty.covariance(row, col));
    }
    rows.push_back(std::move(values));
  }
  return {{"names", uncertainty.names}, {"covariance", std::move(rows)}};
}

}  // namespace striae::detail
