#include "analysis/head/regions.h"

#include <nlohmann/json.hpp>

#include "core/outline.h"

namespace striae::head {
namespace {

Result<std::vector<Eigen::Vector2d>> Polygon(const nlohmann::json& json, const char* name) {
  if (!json.contains(name)) return std::vector<Eigen::Vector2d>{};
  // The outline's reader knows what a polygon must be.
  const auto outline = OutlineFromJson(nlohmann::json{{"polygon_px", json[name]}}.dump());
  if (!outline) return Fail(outline.error(), std::string("reading ") + name);
  return outline->polygon_px;
}

/// [col, row], or none where the name is absent.
Result<std::optional<Eigen::Vector2d>> Point(const nlohmann::json& json, const char* name) {
  if (!json.contains(name)) return std::optional<Eigen::Vector2d>();
  const auto& at = json[name];
  if (!at.is_array() || at.size() != 2 || !at[0].is_number() || !at[1].is_number()) {
    return Fail(ErrorCode::kBadFile, std::string(name) + " must be [col, row]");
  }
  return std::optional(Eigen::Vector2d(at[0].get<double>(), at[1].get<double>()));
}

nlohmann::json Points(const std::vector<Eigen::Vector2d>& polygon) {
  nlohmann::json points = nlohmann::json::array();
  for (const auto& p : polygon) points.push_back({p.x(), p.y()});
  return points;
}

}  // namespace

Result<Regions> RegionsFromJson(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return Fail(ErrorCode::kBadFile, "regions must be a JSON object with head_px or torso_px");
  Regions regions;
  auto head = Polygon(json, "head_px");
  if (!head) return Fail(head.error());
  auto torso = Polygon(json, "torso_px");
  if (!torso) return Fail(torso.error());
  regions.head_px = *std::move(head);
  regions.torso_px = *std::move(torso);
  const auto brow = Point(json, "brow_px"), chin = Point(json, "chin_px");
  if (!brow) return Fail(brow.error());
  if (!chin) return Fail(chin.error());
  if (brow->has_value() != chin->has_value()) {
    return Fail(ErrorCode::kBadFile, "brow_px and chin_px are of use only together");
  }
  regions.brow_px = *brow;
  regions.chin_px = *chin;
  if (regions.head_px.empty() && regions.torso_px.empty() && !regions.brow_px) {
    return Fail(ErrorCode::kBadFile, "no region: give head_px or torso_px as a list of [col, row]");
  }
  if (json.contains("image_sha256")) {
    if (!json["image_sha256"].is_string()) return Fail(ErrorCode::kBadFile, "image_sha256 must be text");
    auto sha = Sha256::Parse(json["image_sha256"].get<std::string>());
    if (!sha) return Fail(sha.error());
    regions.image_sha256 = *sha;
  }
  return regions;
}

std::string ToJsonText(const Regions& regions) {
  nlohmann::json json = nlohmann::json::object();
  if (!regions.head_px.empty()) json["head_px"] = Points(regions.head_px);
  if (!regions.torso_px.empty()) json["torso_px"] = Points(regions.torso_px);
  if (regions.brow_px) json["brow_px"] = {regions.brow_px->x(), regions.brow_px->y()};
  if (regions.chin_px) json["chin_px"] = {regions.chin_px->x(), regions.chin_px->y()};
  if (regions.image_sha256) json["image_sha256"] = regions.image_sha256->ToString();
  return json.dump(2) + "\n";
}

}  // namespace striae::head
