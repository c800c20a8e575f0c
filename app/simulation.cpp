#include "app/simulation.h"

#include <fmt/format.h>

#include "acquire/rig/photograph_file.h"
#include "app/io/files.h"
#include "app/io/images.h"
#include "core/optics.h"
#include "core/outline.h"
#include "core/ply.h"

namespace striae::app {
namespace {

nlohmann::json MatrixJson(const Eigen::Matrix3d& m) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2)});
  return rows;
}

/// The reference mesh as the calibration reads it: vertices and faces, no sensor grid.
std::string ReferencePly(const rig::TriangleMesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertex) surface.point_in_camera.push_back(v.cast<float>());
  surface.colour.assign(surface.size(), Rgb8{200, 200, 200});
  surface.quality.assign(surface.size(), 1.0F);
  surface.col.assign(surface.size(), 0);
  surface.row.assign(surface.size(), 0);
  surface.faces = mesh.triangle;
  const auto bytes = EncodePly(surface);
  return {bytes.begin(), bytes.end()};
}

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
  if (options.distance_mm > 0) simulation.distance_mm_ = options.distance_mm;
  simulation.calibration_ = rig::ScaleSensor(full, options.scale);
  // The exposure is set for the distance, as a photographer would.
  simulation.options_.render.light.reference_mm = simulation.distance_mm_;
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return Fail(ErrorCode::kIo, "cannot make the folder " + options.out.string() + ": " + error.message());
  return simulation;
}

Status Simulation::WriteBeside(const std::string& name, const std::string& text) {
  files_.push_back((options_.out / name).string());
  return WriteText(options_.out / name, text);
}

Status Simulation::Photograph(const std::string& name, const rig::TriangleMesh& mesh, nlohmann::json truth) {
  rig::RenderOptions render = options_.render;
  render.sensor.seed = render.sensor.seed * 1000 + photographs_.size();  // other noise in every photograph
  const auto rendering = rig::Render(mesh, calibration_, render);
  if (!rendering) return Fail(rendering.error());
  rig::CameraTags tags;
  tags.serial = options_.serial;
  tags.taken = options_.taken;
  tags.subsecond = fmt::format("{:02}", photographs_.size() % 100);
  tags.iso = static_cast<int>(render.sensor.iso);
  tags.orientation = options_.orientation;
  const auto jpeg = rig::EncodeJpeg(rendering->photograph, tags, options_.quality);
  if (!jpeg) return Fail(jpeg.error());
  const auto depth = EncodeFloatTiff(rendering->depth_mm);
  if (!depth) return Fail(depth.error());
  const auto lit = EncodeMaskPng(rendering->lit);
  if (!lit) return Fail(lit.error());
  const auto write = [&](const char* kind, const char* ending, const std::vector<std::uint8_t>& bytes) {
    truth[kind] = name + ending;
    files_.push_back((options_.out / (name + ending)).string());
    return WriteFile(options_.out / (name + ending), bytes);
  };
  if (Status done = write("image", ".jpg", *jpeg); !done) return done;
  if (Status done = write("depth", ".depth.tiff", *depth); !done) return done;
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
                             {"calibration", "calibration.json"},
                             {"photographs", photographs_}};
  if (Status done = WriteText(options_.out / "truth.json", document.dump(1)); !done) return Fail(done.error());
  document["files"] = files_;
  return document;
}

Status SimulateLimb(const rig::LimbOptions& first, int visits, Simulation& simulation) {
  for (int visit = 0; visit < visits; ++visit) {
    rig::LimbOptions options = first;
    options.distance_mm = simulation.distance_mm();
    // Healing: the wound shrinks to 35 % of its width and depth; the limb never lies as it did before.
    const double size = visits > 1 ? 1 - 0.65 * visit / (visits - 1) : 1;
    options.crater.depth_mm *= size;
    options.crater.radius_mm *= size;
    options.lean_deg -= 2.5 * visit;
    options.pitch_deg -= 1.5 * visit;
    options.distance_mm += 7 * (visit % 3);
    const auto limb = rig::MakeLimb(options);
    if (!limb) return Fail(limb.error());
    Outline outline;
    nlohmann::json polygon = nlohmann::json::array();
    for (const Eigen::Vector3d& point : limb->truth.outline_in_camera) {
      outline.polygon_px.push_back(Project(simulation.calibration().camera, point));
      polygon.push_back({outline.polygon_px.back().x(), outline.polygon_px.back().y()});
    }
    const std::string name = visits > 1 ? fmt::format("visit_{}", visit) : "limb";
    nlohmann::json truth = {{"visit", visit},
                            {"volume_ml", limb->truth.volume_ml},
                            {"skin_area_cm2", limb->truth.skin_area_cm2},
                            {"surface_area_cm2", limb->truth.bed_area_cm2},
                            {"max_depth_mm", limb->truth.max_depth_mm},
                            {"outline", name + ".outline.json"},
                            {"outline_px", polygon}};
    if (Status done = simulation.WriteBeside(name + ".outline.json", ToJsonText(outline)); !done) return done;
    if (Status done = simulation.Photograph(name, limb->mesh, std::move(truth)); !done) return done;
  }
  return {};
}

Status SimulateBust(const rig::BustOptions& pose, const Eigen::Vector3d& angles, Simulation& simulation) {
  const auto photograph = [&](const std::string& name, rig::BustOptions options, const Eigen::Vector3d& degrees) {
    options.distance_mm = simulation.distance_mm();
    nlohmann::json truth = {{"role", name},
                            {"yaw_deg", degrees.x()},
                            {"pitch_deg", degrees.y()},
                            {"roll_deg", degrees.z()},
                            {"rotation_matrix", MatrixJson(options.head_rotation)},
                            {"torso_rotation_matrix", MatrixJson(options.torso_rotation)}};
    return simulation.Photograph(name, rig::MakeBust(options), std::move(truth));
  };
  rig::BustOptions neutral;
  neutral.seed = pose.seed;
  if (Status done = photograph("neutral", neutral, Eigen::Vector3d::Zero()); !done) return done;
  const bool moved =
      !pose.head_rotation.isIdentity() || !pose.torso_rotation.isIdentity() || !pose.torso_shift_mm.isZero();
  return moved ? photograph("pose", pose, angles) : Status{};
}

Status SimulatePlane(const rig::PlaneOptions& plane, Simulation& simulation) {
  rig::PlaneOptions options = plane;
  options.distance_mm = simulation.distance_mm();
  options.half_size_mm = 0.4 * options.distance_mm;
  const Eigen::Vector3d normal = rig::PlaneNormal(options);
  return simulation.Photograph(
      "plane", rig::MakePlane(options),
      {{"normal", {normal.x(), normal.y(), normal.z()}}, {"distance_mm", options.distance_mm}});
}

Status SimulateSteps(int steps, double step_mm, Simulation& simulation) {
  const double size = simulation.distance_mm() / 1000;
  rig::ReferencePlateOptions plate;
  plate.width_mm *= size;
  plate.height_mm *= size;
  plate.cap_radius_mm *= size;
  plate.cap_height_mm *= size;
  const rig::TriangleMesh reference = rig::MakeReferencePlate(plate);
  if (Status done = simulation.WriteBeside("reference.ply", ReferencePly(reference)); !done) return done;
  // Nearly square to the camera, and a slide that is not quite its axis: both unknown to the calibration.
  const Eigen::Matrix3d rotation = rig::RotationFromPose(3.1, -2.2, 0.8);
  const Eigen::Vector3d slide = Eigen::Vector3d(0.012, -0.008, 1).normalized();
  std::string csv = "image,position_mm\n";
  for (int step = 0; step < steps; ++step) {
    rig::TriangleMesh mesh = reference;
    const double position = step * step_mm, centred = position - (steps - 1) * step_mm / 2;
    rig::Move(rotation, Eigen::Vector3d(2.4, -1.7, simulation.distance_mm()) + centred * slide, mesh);
    const std::string name = fmt::format("step_{:02}", step);
    csv += fmt::format("{}.jpg,{}\n", name, position);
    if (Status done = simulation.Photograph(name, mesh, {{"position_mm", position}}); !done) return done;
  }
  return simulation.WriteBeside("steps.csv", csv);
}

}  // namespace striae::app
