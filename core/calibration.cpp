#include "core/calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/detail/calibration_fields.h"

namespace striae {
namespace {

using detail::Fields;
using nlohmann::json;

// Far beyond any rig, near enough that the optics stay finite.
constexpr double kLargestDistortion = 1000, kLargestRotation_rad = 7, kLargestDistance_mm = 1e6;
constexpr double kLargestFocalSides = 1000, kFarthestCenterSides = 10;  // times the picture's longer side

CameraModel ReadCamera(Fields& fields, double side_px) {
  CameraModel camera;
  camera.fx = fields.Positive("/camera/fx");
  camera.fy = fields.Positive("/camera/fy");
  for (const char* focal : {"/camera/fx", "/camera/fy"}) {
    const double value = fields.Within(focal, kLargestFocalSides * side_px, 0);
    fields.Require(value > side_px / kLargestFocalSides, std::string(focal) + " is not a sensible number");
  }
  camera.cx = fields.Number("/camera/cx");
  camera.cy = fields.Number("/camera/cy");
  fields.Within("/camera/cx", kFarthestCenterSides * side_px, 0);
  fields.Within("/camera/cy", kFarthestCenterSides * side_px, 0);
  camera.k1 = fields.Within("/camera/k1", kLargestDistortion, 0);
  camera.k2 = fields.Within("/camera/k2", kLargestDistortion, 0);
  camera.p1 = fields.Within("/camera/p1", kLargestDistortion, 0);
  camera.p2 = fields.Within("/camera/p2", kLargestDistortion, 0);
  return camera;
}

ProjectorModel ReadProjector(Fields& fields, const json& root) {
  ProjectorModel projector;
  projector.center_mm = fields.Vector("/projector/center_mm", kLargestDistance_mm);
  const std::string model = root.at("projector").value("model", "pinhole");
  if (model == "angular") {
    projector.kind = ProjectorModel::Kind::kAngular;
    projector.a0_rad = fields.Number("/projector/a0_rad");
    fields.Within("/projector/a0_rad", kLargestRotation_rad, 0);
    projector.delta_a_rad = fields.Number("/projector/delta_a_rad");
    fields.Within("/projector/delta_a_rad", kLargestRotation_rad, 0);
    fields.Require(projector.delta_a_rad != 0, "/projector/delta_a_rad is zero");
    return projector;
  }
  fields.Require(model == "pinhole", "/projector/model is neither \"pinhole\" nor \"angular\"");
  projector.rotation_rodrigues = fields.Vector("/projector/rotation_rodrigues", kLargestRotation_rad);
  projector.focal_stripes = fields.Positive("/projector/focal_stripes");
  projector.center_order = fields.Number("/projector/center_order");
  projector.k1 = fields.Within("/projector/k1", kLargestDistortion, 0);
  return projector;
}

void ReadGrating(Fields& fields, const json& root, Calibration& calibration) {
  const json& grating = root.at("grating");
  const std::string direction = grating.value("direction", "horizontal");
  fields.Require(direction == "horizontal" || direction == "vertical",
                 "/grating/direction is neither \"horizontal\" nor \"vertical\"");
  calibration.direction = direction == "vertical" ? StripeDirection::kVertical : StripeDirection::kHorizontal;
  if (!grating.contains("stripes") || grating.at("stripes").is_null()) return;
  const double stripes = fields.Positive("/grating/stripes");
  fields.Require(stripes >= 4 && stripes < 10000 && stripes == std::floor(stripes),
                 "/grating/stripes is not a whole number from 4 to 9999");
  calibration.stripes = static_cast<int>(stripes);
}

void ReadOrigin(Fields& fields, const json& root, Calibration& calibration) {
  if (root.contains("quality") && root.at("quality").is_object()) {
    const double sd_mm = fields.NumberOr("/quality/sd_mm", 0);
    const double photographs = fields.NumberOr("/quality/photographs", 0);
    fields.Require(sd_mm >= 0 && photographs >= 0, "/quality has a negative number");
    calibration.quality = Calibration::Quality{sd_mm, static_cast<int>(photographs)};
  }
  for (const json& source : root.value("sources", json::array())) {
    const auto sha256 = Sha256::Parse(source.at("sha256").get<std::string>());
    fields.Require(sha256.has_value(), "/sources has a sha256 that is none");
    const double position = source.at("position_mm").get<double>();
    fields.Require(std::isfinite(position), "/sources has a position that is not finite");
    if (sha256) calibration.sources.push_back({*sha256, position});
  }
}

Calibration ReadAll(Fields& fields, const json& root) {
  Calibration calibration;
  fields.Require(root.value("format", "") == "striae-calibration/1", "/format is not \"striae-calibration/1\"");
  const double width = fields.Positive("/image_size/0");
  const double height = fields.Positive("/image_size/1");
  fields.Require(width <= 65535 && height <= 65535 && width == std::floor(width) && height == std::floor(height),
                 "/image_size is not two whole numbers up to 65535");
  if (!fields.problem().empty()) return calibration;
  calibration.image_width_px = static_cast<int>(width);
  calibration.image_height_px = static_cast<int>(height);
  calibration.camera = ReadCamera(fields, std::max(width, height));
  calibration.projector = ReadProjector(fields, root);
  ReadGrating(fields, root, calibration);
  calibration.near_mm = fields.Positive("/working_distance_mm/0");
  calibration.far_mm = fields.Positive("/working_distance_mm/1");
  fields.Require(calibration.near_mm < calibration.far_mm, "/working_distance_mm is not [near, far]");
  fields.Within("/working_distance_mm/1", kLargestDistance_mm, 0);
  ReadOrigin(fields, root, calibration);
  detail::ReadUncertainty(fields, root, calibration);
  return calibration;
}

json ProjectorToJson(const ProjectorModel& projector) {
  const auto vector = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
  json object = {{"center_mm", vector(projector.center_mm)}};
  if (projector.kind == ProjectorModel::Kind::kAngular) {
    object["model"] = "angular";
    object["a0_rad"] = projector.a0_rad;
    object["delta_a_rad"] = projector.delta_a_rad;
    return object;
  }
  object["model"] = "pinhole";
  object["rotation_rodrigues"] = vector(projector.rotation_rodrigues);
  object["focal_stripes"] = projector.focal_stripes;
  object["center_order"] = projector.center_order;
  object["k1"] = projector.k1;
  return object;
}

}  // namespace

std::string_view ToString(StripeDirection direction) {
  return direction == StripeDirection::kHorizontal ? "horizontal" : "vertical";
}

double* CalibrationParameter(Calibration& c, std::string_view name) {
  const std::pair<std::string_view, double*> common[] = {{"camera.fx", &c.camera.fx},
                                                         {"camera.fy", &c.camera.fy},
                                                         {"camera.cx", &c.camera.cx},
                                                         {"camera.cy", &c.camera.cy},
                                                         {"camera.k1", &c.camera.k1},
                                                         {"camera.k2", &c.camera.k2},
                                                         {"camera.p1", &c.camera.p1},
                                                         {"camera.p2", &c.camera.p2},
                                                         {"projector.center_x", &c.projector.center_mm.x()},
                                                         {"projector.center_y", &c.projector.center_mm.y()},
                                                         {"projector.center_z", &c.projector.center_mm.z()}};
  const std::pair<std::string_view, double*> pinhole[] = {{"projector.rotation_x", &c.projector.rotation_rodrigues.x()},
                                                          {"projector.rotation_y", &c.projector.rotation_rodrigues.y()},
                                                          {"projector.rotation_z", &c.projector.rotation_rodrigues.z()},
                                                          {"projector.focal_stripes", &c.projector.focal_stripes},
                                                          {"projector.center_order", &c.projector.center_order},
                                                          {"projector.k1", &c.projector.k1}};
  const std::pair<std::string_view, double*> angular[] = {{"projector.a0_rad", &c.projector.a0_rad},
                                                          {"projector.delta_a_rad", &c.projector.delta_a_rad}};
  const auto find = [&](const auto& list) -> double* {
    for (const auto& [known, field] : list) {
      if (known == name) return field;
    }
    return nullptr;
  };
  if (double* field = find(common)) return field;
  return c.projector.kind == ProjectorModel::Kind::kAngular ? find(angular) : find(pinhole);
}

Result<Calibration> CalibrationFromJson(std::string_view text) {
  const auto bad = [](const std::string& what) {
    return Fail(ErrorCode::kBadCalibration,
                "not a usable calibration: " + what + "; calibrate the rig again or restore the file from the study");
  };
  const auto root = detail::ParseStrictJson(text);
  if (!root) return bad(root.error().message);
  try {
    Fields fields(*root);
    Calibration calibration = ReadAll(fields, *root);
    if (!fields.problem().empty()) return bad(fields.problem());
    return calibration;
  } catch (const json::exception& e) {
    return bad(e.what());
  }
}

std::string ToJsonText(const Calibration& c) {
  json root = {{"format", "striae-calibration/1"},
               {"image_size", {c.image_width_px, c.image_height_px}},
               {"camera",
                {{"fx", c.camera.fx},
                 {"fy", c.camera.fy},
                 {"cx", c.camera.cx},
                 {"cy", c.camera.cy},
                 {"k1", c.camera.k1},
                 {"k2", c.camera.k2},
                 {"p1", c.camera.p1},
                 {"p2", c.camera.p2}}},
               {"projector", ProjectorToJson(c.projector)},
               {"grating", {{"stripes", nullptr}, {"direction", ToString(c.direction)}}},
               {"working_distance_mm", {c.near_mm, c.far_mm}}};
  if (c.stripes) root["grating"]["stripes"] = *c.stripes;
  if (c.quality) root["quality"] = {{"sd_mm", c.quality->sd_mm}, {"photographs", c.quality->photographs}};
  for (const auto& source : c.sources) {
    root["sources"].push_back({{"sha256", source.sha256.ToString()}, {"position_mm", source.position_mm}});
  }
  if (c.uncertainty) root["uncertainty"] = detail::ToJson(*c.uncertainty);
  return root.dump(1) + "\n";
}

}  // namespace striae
