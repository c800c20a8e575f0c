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
  if (regions.head_px.empty() && regions.torso_px.empty()) {
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
  if (regions.image_sha256) json["image_sha256"] = regions.image_sha256->ToString();
  return json.dump(2) + "\n";
}

}  // namespace striae::head
