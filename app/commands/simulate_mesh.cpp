// `striae simulate mesh FILE`: any body from a file, placed before the virtual rig.
#include <map>

#include "acquire/rig/mesh_file.h"
#include "app/command.h"
#include "app/simulation_options.h"

namespace striae::app {
namespace {

struct MeshCommand {
  std::filesystem::path file;
  rig::MeshFileOptions read;
  double albedo = -1;  ///< negative: the file's colours
  double yaw_deg = 0, pitch_deg = 0, roll_deg = 0;
  std::vector<double> shift_mm = {0, 0, 0};
  bool about_origin = false, in_camera = false;
};

/// What the body turns about: the middle of its bounding box, or its file's origin.
Eigen::Vector3d Pivot(const MeshCommand& command, const rig::TriangleMesh& mesh) {
  if (command.about_origin || command.in_camera) return Eigen::Vector3d::Zero();
  Eigen::Vector3d low = mesh.vertex.front(), high = low;
  for (const Eigen::Vector3d& v : mesh.vertex) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (low + high) / 2;
}

Status SimulateMesh(const MeshCommand& command, Simulation& simulation) {
  rig::MeshFileOptions read = command.read;
  if (command.albedo >= 0) read.albedo = command.albedo;
  auto mesh = rig::ReadMesh(command.file, read);
  if (!mesh) return Fail(mesh.error());
  const Eigen::Matrix3d rotation = rig::RotationFromPose(command.yaw_deg, command.pitch_deg, command.roll_deg);
  Eigen::Vector3d place(command.shift_mm.data());
  if (!command.in_camera) place.z() += simulation.distance_mm();
  const Eigen::Vector3d translation = place - rotation * Pivot(command, *mesh);
  rig::Move(rotation, translation, *mesh);
  nlohmann::json matrix = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) matrix.push_back({rotation(i, 0), rotation(i, 1), rotation(i, 2)});
  return simulation.Photograph("mesh", std::move(*mesh),
                               {{"mesh", command.file.filename().string()},
                                {"unit_mm", read.unit_mm},
                                {"rotation_matrix", matrix},
                                {"translation_mm", {translation.x(), translation.y(), translation.z()}}});
}

}  // namespace

void AddCommand_simulate_mesh(CLI::App& root, Context& context) {
  const auto options = std::make_shared<MeshCommand>();
  CLI::App* command = AddScene(root, context, "mesh", "A body from a mesh file: OBJ, PLY or STL",
                               "striae simulate mesh head.obj --unit-mm 10 --axes y-up --yaw 20 --out scene", "small",
                               [options](Simulation& s) { return SimulateMesh(*options, s); });
  command->add_option("file", options->file, "OBJ (vertex colours, or MTL with colour or picture), PLY or STL")
      ->required();
  command->add_option("--unit-mm", options->read.unit_mm, "The file's unit: 1 for mm, 10 for cm, 1000 for m")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  const std::map<std::string, rig::MeshAxes> axes = {
      {"camera", rig::MeshAxes::kCamera}, {"y-up", rig::MeshAxes::kYUp}, {"z-up", rig::MeshAxes::kZUp}};
  command->add_option("--axes", options->read.axes, "Of the file: camera (y down, z away), y-up or z-up")
      ->transform(CLI::CheckedTransformer(axes));
  command->add_option("--albedo", options->albedo, "Of the whole body instead of the file's colours, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  const auto angle = CLI::Range(-360.0, 360.0);
  command->add_option("--yaw", options->yaw_deg, "About the camera's y axis, degrees")->check(angle);
  command->add_option("--pitch", options->pitch_deg, "About the camera's x axis, degrees")->check(angle);
  command->add_option("--roll", options->roll_deg, "About the camera's z axis, degrees")->check(angle);
  command->add_option("--shift", options->shift_mm, "Of the body: x y z, mm")->expected(3);
  command->add_flag("--about-origin", options->about_origin,
                    "Turn about the file's origin and put that at the distance, not the middle of the body");
  command->add_flag("--in-camera", options->in_camera, "The file is in the camera frame already: no distance is added");
}

}  // namespace striae::app
