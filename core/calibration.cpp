#include "core/calibration.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace striae {
namespace {

using nlohmann::json;

/// Collects the first thing wrong, so that the reader below reads as a list of fields.
class Fields {
 public:
  explicit Fields(const json& root) : root_(root) {}

  double Number(const char* path) { return Number(path, root_.contains(json::json_pointer(path))); }
  double NumberOr(const char* path, double fallback) {
    return root_.contains(json::json_pointer(path)) ? Number(path, true) : fallback;
  }
  double Positive(const char* path) {
    const double value = Number(path);
    if (!problem_.empty() || value > 0) return value;
    problem_ = std::string(path) + " must be positive";
    return value;
  }
  Eigen::Vector3d Vector(const char* path) {
    const std::string base(path);
    return {Number((base + "/0").c_str()), Number((base + "/1").c_str()), Number((base + "/2").c_str())};
  }
  void Require(bool holds, const std::string& what) {
    if (!holds && problem_.empty()) problem_ = what;
  }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  double Number(const char* path, bool present) {
    const json::json_pointer pointer(path);
    if (!present || !root_.at(pointer).is_number()) {
      Require(false, std::string(path) + (present ? " is not a number" : " is missing"));
      return 0;
    }
    const double value = root_.at(pointer).get<double>();
    Require(std::isfinite(value) && std::abs(value) < 1e9, std::string(path) + " is not a sensible number");
    return value;
  }

  const json& root_;
  std::string problem_;
};

CameraModel ReadCamera(Fields& fields) {
  CameraModel camera;
  camera.fx = fields.Positive("/camera/fx");
  camera.fy = fields.Positive("/camera/fy");
  camera.cx = fields.Number("/camera/cx");
  camera.cy = fields.Number("/camera/cy");
  camera.k1 = fields.NumberOr("/camera/k1", 0);
  camera.k2 = fields.NumberOr("/camera/k2", 0);
  camera.p1 = fields.NumberOr("/camera/p1", 0);
  camera.p2 = fields.NumberOr("/camera/p2", 0);
  return camera;
}

ProjectorModel ReadProjector(Fields& fields, const json& root) {
  ProjectorModel projector;
  projector.center_mm = fields.Vector("/projector/center_mm");
  const std::string model = root.at("projector").value("model", "pinhole");
  if (model == "angular") {
    projector.kind = ProjectorModel::Kind::kAngular;
    projector.a0_rad = fields.Number("/projector/a0_rad");
    projector.delta_a_rad = fields.Number("/projector/delta_a_rad");
    fields.Require(projector.delta_a_rad != 0, "/projector/delta_a_rad is zero");
    return projector;
  }
  fields.Require(model == "pinhole", "/projector/model is neither \"pinhole\" nor \"angular\"");
  projector.rotation_rodrigues = fields.Vector("/projector/rotation_rodrigues");
  projector.focal_stripes = fields.Positive("/projector/focal_stripes");
  projector.center_order = fields.Number("/projector/center_order");
  projector.k1 = fields.NumberOr("/projector/k1", 0);
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
    calibration.quality = Calibration::Quality{fields.NumberOr("/quality/sd_mm", 0),
                                               static_cast<int>(fields.NumberOr("/quality/photographs", 0))};
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
  calibration.camera = ReadCamera(fields);
  calibration.projector = ReadProjector(fields, root);
  ReadGrating(fields, root, calibration);
  calibration.near_mm = fields.Positive("/working_distance_mm/0");
  calibration.far_mm = fields.Positive("/working_distance_mm/1");
  fields.Require(calibration.near_mm < calibration.far_mm, "/working_distance_mm is not [near, far]");
  ReadOrigin(fields, root, calibration);
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

Result<Calibration> CalibrationFromJson(std::string_view text) {
  const auto bad = [](const std::string& what) {
    return Fail(ErrorCode::kBadCalibration,
                "not a usable calibration: " + what + "; calibrate the rig again or restore the file from the study");
  };
  try {
    const json root = json::parse(text);
    Fields fields(root);
    Calibration calibration = ReadAll(fields, root);
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
  return root.dump(1) + "\n";
}

}  // namespace striae
