#include <fmt/format.h>

#include "app/simulation_scenes.h"
#include "core/optics.h"
#include "core/outline.h"

namespace striae::app {
namespace {

nlohmann::json MatrixJson(const Eigen::Matrix3d& m) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2)});
  return rows;
}

}  // namespace

Status SimulateLimb(const rig::LimbOptions& first, int visits, Simulation& simulation) {
  simulation.Expect(static_cast<std::size_t>(visits));
  for (int visit = 0; visit < visits; ++visit) {
    rig::LimbOptions options = first;
    options.seed = simulation.seed();
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
    options.seed = simulation.seed();
    nlohmann::json truth = {{"role", name},
                            {"yaw_deg", degrees.x()},
                            {"pitch_deg", degrees.y()},
                            {"roll_deg", degrees.z()},
                            {"rotation_matrix", MatrixJson(options.head_rotation)},
                            {"torso_rotation_matrix", MatrixJson(options.torso_rotation)}};
    return simulation.Photograph(name, rig::MakeBust(options), std::move(truth));
  };
  rig::BustOptions neutral = pose;
  neutral.head_rotation = neutral.torso_rotation = Eigen::Matrix3d::Identity();
  neutral.torso_shift_mm.setZero();
  const bool moved =
      !pose.head_rotation.isIdentity() || !pose.torso_rotation.isIdentity() || !pose.torso_shift_mm.isZero();
  simulation.Expect(moved ? 2 : 1);
  if (Status done = photograph("neutral", neutral, Eigen::Vector3d::Zero()); !done) return done;
  return moved ? photograph("pose", pose, angles) : Status{};
}

}  // namespace striae::app
