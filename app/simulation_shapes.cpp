#include <fmt/format.h>

#include "app/simulation_scenes.h"
#include "core/ply.h"

namespace striae::app {
namespace {

nlohmann::json PointJson(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// The reference mesh as the calibration reads it: vertices and faces, no sensor grid.
std::string ReferencePly(const rig::TriangleMesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertex) surface.point_in_camera.push_back(v.cast<float>());
  surface.colour.assign(surface.size(), Rgb8{200, 200, 200});
  surface.quality.assign(surface.size(), 1.0F);
  surface.col.assign(surface.size(), 0);
  surface.row.assign(surface.size(), 0);
  surface.faces.assign(mesh.triangle.begin(), mesh.triangle.end());
  const auto bytes = EncodePly(surface);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Status SimulatePlane(const rig::PlaneOptions& plane, Simulation& simulation) {
  rig::PlaneOptions options = plane;
  options.distance_mm = simulation.distance_mm();
  options.half_size_mm = 0.4 * options.distance_mm;
  const Eigen::Vector3d normal = rig::PlaneNormal(options);
  return simulation.Photograph("plane", rig::MakePlane(options),
                               {{"normal", PointJson(normal)},
                                {"point_mm", PointJson({0, 0, options.distance_mm})},
                                {"distance_mm", options.distance_mm}});
}

Status SimulateBall(const BallScene& scene, Simulation& simulation) {
  rig::BallOptions ball;
  ball.radius_mm = scene.radius_mm > 0 ? scene.radius_mm : 0.075 * simulation.distance_mm();
  ball.center_mm = {scene.x_mm, scene.y_mm, simulation.distance_mm() + ball.radius_mm};
  auto mesh = rig::MakeBall(ball);
  if (!mesh) return Fail(mesh.error());
  return simulation.Photograph("ball", std::move(*mesh),
                               {{"center_mm", PointJson(ball.center_mm)}, {"radius_mm", ball.radius_mm}});
}

Status SimulateBlocks(const rig::BlocksOptions& given, double tilt_x_deg, double tilt_y_deg, Simulation& simulation) {
  rig::BlocksOptions blocks = given;
  const double size = simulation.distance_mm() / 1000;  // the plate stays larger than the field
  blocks.plate_width_mm *= size;
  blocks.plate_height_mm *= size;
  auto mesh = rig::MakeBlocks(blocks);
  if (!mesh) return Fail(mesh.error());
  const Eigen::Matrix3d rotation = rig::RotationFromPose(tilt_y_deg, tilt_x_deg, 0);
  const Eigen::Vector3d place(0, 0, simulation.distance_mm());
  rig::Move(rotation, place, *mesh);
  nlohmann::json faces = nlohmann::json::array();
  for (std::size_t i = 0; i < blocks.heights_mm.size(); ++i) {
    faces.push_back({{"height_mm", blocks.heights_mm[i]},
                     {"center_mm", PointJson(rotation * rig::BlockCenter(blocks, i) + place)}});
  }
  return simulation.Photograph("blocks", std::move(*mesh),
                               {{"normal", PointJson(rotation * Eigen::Vector3d(0, 0, -1))},
                                {"plate_point_mm", PointJson(place)},
                                {"block_mm", blocks.block_mm},
                                {"blocks", faces}});
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
  simulation.Expect(static_cast<std::size_t>(steps));
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
