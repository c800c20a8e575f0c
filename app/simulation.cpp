#include "app/simulation.h"

#include <fmt/format.h>

#include "app/io/files.h"
#include "app/io/images.h"
#include "app/progress.h"
#include "core/optics.h"

namespace striae::app {
namespace {

/// Pupils of the rig's lenses, mm: the camera's 50 mm at f/11, the projector's 25 mm at f/5.6.
constexpr double kCameraPupil_mm = 50.0 / 11, kProjectorPupil_mm = 25.0 / 5.6;

nlohmann::json PointJson(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

Result<Simulation> Simulation::Prepare(const SimulationOptions& options) {
  if (!(options.scale > 0 && options.scale <= 1)) return Fail(ErrorCode::kUsage, "--scale must lie between 0 and 1");
  Simulation simulation;
  simulation.options_ = options;
  const auto nominal = rig::DefaultRig(options.range == "large" ? rig::Range::kLarge : rig::Range::kSmall);
  Calibration full = nominal.calibration;
  simulation.distance_mm_ = nominal.distance_mm;
  if (!options.rig_file.empty()) {
    const auto text = ReadText(options.rig_file);
    if (!text) return Fail(text.error());
    const auto read = CalibrationFromJson(*text);
    if (!read) return Fail(read.error(), "reading the rig " + options.rig_file.string());
    full = *read;
    simulation.distance_mm_ = (full.near_mm + full.far_mm) / 2;
  }
  const double rig_distance_mm = simulation.distance_mm_;
  if (options.distance_mm > 0) simulation.distance_mm_ = options.distance_mm;
  simulation.calibration_ = rig::ScaleSensor(full, options.scale);
  // The exposure is set for the distance, as a photographer would.
  rig::RenderOptions& render = simulation.options_.render;
  render.light.reference_mm = simulation.distance_mm_;
  render.sensor.focus_mm = options.focus_mm > 0 ? options.focus_mm : rig_distance_mm;
  // The projector is focused on the same place of the axis as the camera.
  render.light.focus_mm = (Eigen::Vector3d(0, 0, render.sensor.focus_mm) - full.projector.center_mm).norm();
  render.sensor.aperture_mm = options.sharp ? 0 : kCameraPupil_mm;
  render.light.aperture_mm = options.sharp ? 0 : kProjectorPupil_mm;
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return Fail(ErrorCode::kIo, "cannot make the folder " + options.out.string() + ": " + error.message());
  return simulation;
}

Status Simulation::WriteBeside(const std::string& name, const std::string& text) {
  files_.push_back((options_.out / name).string());
  return WriteText(options_.out / name, text);
}

void Simulation::MoveByPixels(const Eigen::Vector2d& motion_px) {
  const CameraModel& camera = calibration_.camera;
  options_.render.motion_mm = distance_mm_ * Eigen::Vector3d(motion_px.x() / camera.fx, motion_px.y() / camera.fy, 0);
}

Result<nlohmann::json> Simulation::PutLabels(rig::TriangleMesh& mesh) const {
  nlohmann::json labels = nlohmann::json::array();
  for (const rig::LabelOptions& label : options_.labels) {
    const auto truth = rig::PaintLabel(label, mesh);
    if (!truth) return Fail(truth.error());
    nlohmann::json corners_mm = nlohmann::json::array(), corners_px = nlohmann::json::array();
    for (const Eigen::Vector3d& corner : truth->corner_in_camera) {
      corners_mm.push_back(PointJson(corner));
      const Eigen::Vector2d pixel = Project(calibration_.camera, corner);
      corners_px.push_back({pixel.x(), pixel.y()});
    }
    labels.push_back(
        {{"id", label.id}, {"side_mm", label.side_mm}, {"corners_mm", corners_mm}, {"corners_px", corners_px}});
  }
  return labels;
}

rig::CameraTags Simulation::Tags() const {
  rig::CameraTags tags;
  tags.serial = options_.serial;
  tags.taken = options_.taken;
  tags.subsecond = fmt::format("{:02}", photographs_.size() % 100);
  tags.iso = static_cast<int>(options_.render.sensor.iso);
  tags.orientation = options_.orientation;
  tags.focus_mm = options_.render.sensor.focus_mm;
  tags.shutter_count += static_cast<int>(photographs_.size());
  return tags;
}

Status Simulation::Photograph(const std::string& name, rig::TriangleMesh mesh, nlohmann::json truth) {
  ProgressBar progress;
  progress.Show(photographs_.size(), expected_, "rendering " + name);
  const auto labels = PutLabels(mesh);
  if (!labels) return Fail(labels.error());
  if (!labels->empty()) truth["labels"] = *labels;
  rig::RenderOptions render = options_.render;
  render.sensor.seed = render.sensor.seed * 1000 + photographs_.size();  // other noise in every photograph
  const auto rendering = rig::Render(mesh, calibration_, render);
  if (!rendering) return Fail(rendering.error());
  const auto jpeg = rig::EncodeJpeg(rendering->photograph, Tags(), options_.quality);
  if (!jpeg) return Fail(jpeg.error());
  const auto depth = EncodeFloatTiff(rendering->depth_mm), order = EncodeFloatTiff(rendering->order);
  if (!depth || !order) return Fail(depth ? order.error() : depth.error());
  const auto lit = EncodeMaskPng(rendering->lit);
  if (!lit) return Fail(lit.error());
  const auto write = [&](const char* kind, const char* ending, const std::vector<std::uint8_t>& bytes) {
    truth[kind] = name + ending;
    files_.push_back((options_.out / (name + ending)).string());
    return WriteFile(options_.out / (name + ending), bytes);
  };
  if (Status done = write("image", ".jpg", *jpeg); !done) return done;
  if (Status done = write("depth", ".depth.tiff", *depth); !done) return done;
  if (Status done = write("order", ".order.tiff", *order); !done) return done;
  if (Status done = write("lit", ".lit.png", *lit); !done) return done;
  photographs_.push_back(std::move(truth));
  return {};
}

Result<nlohmann::json> Simulation::Finish(const std::string& scene) {
  if (Status done = WriteBeside("calibration.json", ToJsonText(calibration_)); !done) return Fail(done.error());
  files_.push_back((options_.out / "truth.json").string());
  nlohmann::json document = {{"scene", scene},
                             {"distance_mm", distance_mm_},
                             {"scale", options_.scale},
                             {"seed", options_.render.sensor.seed},
                             {"focus_mm", options_.render.sensor.focus_mm},
                             {"motion_mm", PointJson(options_.render.motion_mm)},
                             {"calibration", "calibration.json"},
                             {"photographs", photographs_}};
  if (Status done = WriteText(options_.out / "truth.json", document.dump(1)); !done) return Fail(done.error());
  document["files"] = files_;
  return document;
}

}  // namespace striae::app
