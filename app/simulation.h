// What `striae simulate` makes: photographs by the virtual rig, and the truth beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "acquire/rig/bust.h"
#include "acquire/rig/default_rig.h"
#include "acquire/rig/limb.h"
#include "acquire/rig/plane.h"
#include "acquire/rig/render.h"

namespace striae::app {

struct SimulationOptions {
  std::filesystem::path out;       ///< folder; made when absent
  std::filesystem::path rig_file;  ///< calibration of the true rig; empty: the range's default rig
  std::string range = "small";
  double scale = 1;           ///< of the sensor's pixel count a side
  double distance_mm = 0;     ///< 0: the range's
  std::string taken, serial;  ///< EXIF
  int orientation = 1, quality = 92;
  rig::RenderOptions render;
};

/// Renders one scene after the other into one folder and collects the truth.
class Simulation {
 public:
  /// Reads and scales the rig. kUsage for a scale outside 0..1.
  static Result<Simulation> Prepare(const SimulationOptions& options);

  /// Writes <name>.jpg, <name>.depth.tiff and <name>.lit.png and adds `truth` to the list.
  Status Photograph(const std::string& name, const rig::TriangleMesh& mesh, nlohmann::json truth);
  /// Writes a file beside the photographs; `name` is listed with them.
  Status WriteBeside(const std::string& name, const std::string& text);
  /// Writes calibration.json and truth.json; returns the document for --json.
  Result<nlohmann::json> Finish(const std::string& scene);

  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  [[nodiscard]] double distance_mm() const { return distance_mm_; }

 private:
  SimulationOptions options_;
  Calibration calibration_;
  double distance_mm_ = 0;
  nlohmann::json photographs_ = nlohmann::json::array(), files_ = nlohmann::json::array();
};

/// A limb with a wound that heals over `visits` photographs, each newly positioned; outlines beside.
Status SimulateLimb(const rig::LimbOptions& limb, int visits, Simulation& simulation);
/// The neutral bust, and the posed one when `pose` turns or moves anything.
Status SimulateBust(const rig::BustOptions& pose, const Eigen::Vector3d& yaw_pitch_roll_deg, Simulation& simulation);
/// A plate of known plane.
Status SimulatePlane(const rig::PlaneOptions& plane, Simulation& simulation);
/// The reference plate on a slide away from the camera: reference.ply, steps.csv and its photographs.
Status SimulateSteps(int steps, double step_mm, Simulation& simulation);

}  // namespace striae::app
