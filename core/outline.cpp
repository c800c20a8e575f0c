#include "core/outline.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace striae {
namespace {

using nlohmann::json;

constexpr std::size_t kMostPoints = 20000;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool Meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const double c_side = Cross(b - a, c - a), d_side = Cross(b - a, d - a);
  const double a_side = Cross(d - c, a - c), b_side = Cross(d - c, b - c);
  return ((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0));
}

double Area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return std::abs(twice) / 2;
}

// A hand's tremor, or a dense line with every point a little off, makes small loops: each that encloses less than
// kSmallLoop of the rest is cut off where the line crosses itself. What is larger is left for the caller to refuse.
std::vector<Eigen::Vector2d> WithoutSmallLoops(std::vector<Eigen::Vector2d> polygon) {
  constexpr double kSmallLoop = 0.02;
  for (std::size_t i = 0; i + 2 < polygon.size(); ++i) {
    for (std::size_t j = i + 2; j < polygon.size(); ++j) {
      const std::size_t n = polygon.size();
      if (i == 0 && j == n - 1) continue;
      const Eigen::Vector2d a = polygon[i], b = polygon[i + 1], c = polygon[j], d = polygon[(j + 1) % n];
      if (!Meet(a, b, c, d)) continue;
      const Eigen::Vector2d crossing = a + Cross(c - a, d - c) / Cross(b - a, d - c) * (b - a);
      const auto at = [&](std::size_t k) { return polygon.begin() + static_cast<std::ptrdiff_t>(k); };
      std::vector<Eigen::Vector2d> loop = {crossing}, rest(polygon.begin(), at(i + 1));
      loop.insert(loop.end(), at(i + 1), at(j + 1));
      rest.push_back(crossing);
      rest.insert(rest.end(), at(j + 1), polygon.end());
      const double loop_area = Area(loop), rest_area = Area(rest);
      if (loop_area < kSmallLoop * rest_area) {
        polygon = std::move(rest);
        j = i + 1;  // the side is shorter now and may cross once more
      } else if (rest_area < kSmallLoop * loop_area) {
        polygon = std::move(loop);
        i = 0;
        j = 1;
      } else {
        return polygon;
      }
    }
  }
  return polygon;
}

std::vector<Eigen::Vector2d> ReadPoints(const json& points, double shift_px) {
  std::vector<Eigen::Vector2d> polygon;
  for (const json& point : points) {
    polygon.emplace_back(point.at(0).get<double>() - shift_px, point.at(1).get<double>() - shift_px);
  }
  if (polygon.size() > 3 && polygon.front() == polygon.back()) polygon.pop_back();
  return polygon;
}

/// The one polygon of a LabelMe file; an empty vector with `problem` set when there is not exactly one.
std::vector<Eigen::Vector2d> ReadLabelMe(const json& root, std::string& problem) {
  constexpr double kLabelMeShiftPx = 0.5;  // there, the first pixel's centre is (0.5, 0.5)
  const json* found = nullptr;
  for (const json& shape : root.at("shapes")) {
    if (shape.value("shape_type", "polygon") != "polygon") continue;
    if (found != nullptr) {
      problem = "the LabelMe file holds several polygons; save one file for each wound";
      return {};
    }
    found = &shape;
  }
  if (found == nullptr) {
    problem = "the LabelMe file holds no polygon";
    return {};
  }
  return ReadPoints(found->at("points"), kLabelMeShiftPx);
}

std::string BadPoints(const std::vector<Eigen::Vector2d>& polygon) {
  if (polygon.size() < 3) return "an outline needs at least three points";
  if (polygon.size() > kMostPoints) return "the outline has more than 20000 points";
  for (const auto& point : polygon) {
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1e6) return "the outline has a point that is no pixel";
  }
  return {};
}

}  // namespace

bool SelfCrossing(const std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours around the end
      if (Meet(polygon[i], polygon[(i + 1) % n], polygon[j], polygon[(j + 1) % n])) return true;
    }
  }
  return false;
}

bool Inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& a = polygon[i];
    const auto& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

Result<Outline> OutlineFromJson(std::string_view text) {
  try {
    const json root = json::parse(text);
    Outline outline;
    std::string problem;
    outline.polygon_px = root.contains("shapes") ? ReadLabelMe(root, problem) : ReadPoints(root.at("polygon_px"), 0);
    if (problem.empty()) problem = BadPoints(outline.polygon_px);
    if (problem.empty()) {
      outline.polygon_px = WithoutSmallLoops(std::move(outline.polygon_px));
      if (SelfCrossing(outline.polygon_px)) problem = "the outline crosses itself; draw it again as one simple loop";
    }
    if (!problem.empty()) return Fail(ErrorCode::kBadFile, problem);
    if (root.contains("image_sha256") && !root.at("image_sha256").is_null()) {
      const auto sha256 = Sha256::Parse(root.at("image_sha256").get<std::string>());
      if (!sha256) return Fail(sha256.error(), "image_sha256 of the outline");
      outline.image_sha256 = *sha256;
    }
    return outline;
  } catch (const json::exception& e) {
    return Fail(ErrorCode::kBadFile, std::string("not an outline (neither polygon_px nor LabelMe): ") + e.what());
  }
}

std::string ToJsonText(const Outline& outline) {
  json root = {{"polygon_px", json::array()}};
  for (const auto& point : outline.polygon_px) root["polygon_px"].push_back({point.x(), point.y()});
  if (outline.image_sha256) root["image_sha256"] = outline.image_sha256->ToString();
  return root.dump() + "\n";
}

}  // namespace striae
