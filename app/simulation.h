// What `striae simulate` makes: photographs by the virtual rig, and the truth beside them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "acquire/rig/default_rig.h"
#include "acquire/rig/label.h"
#include "acquire/rig/photograph_file.h"
#include "acquire/rig/render.h"
#include "core/calibration.h"

namespace striae::app {

struct SimulationOptions {
  std::filesystem::path out;       ///< folder; made when absent
  std::filesystem::path rig_file;  ///< calibration of the true rig; empty: the range's default rig
  std::string range = "small";
  double scale = 1;           ///< of the sensor's pixel count a side
  double distance_mm = 0;     ///< 0: the range's
  double focus_mm = 0;        ///< where camera and projector are focused; 0: the rig's distance
  bool sharp = false;         ///< no defocus, whatever the depth
  std::string taken, serial;  ///< EXIF
  int orientation = 1, quality = 92;
  std::vector<rig::LabelOptions> labels;  ///< painted onto every body
  rig::RenderOptions render;
};

/// Renders one scene after the other into one folder and collects the truth.
class Simulation {
 public:
  /// Reads and scales the rig. kUsage for a scale outside 0..1.
  static Result<Simulation> Prepare(const SimulationOptions& options);

  /// Lets the body move so far in the image during each exposure, at the scene's distance.
  void MoveByPixels(const Eigen::Vector2d& motion_px);
  /// How many photographs will follow, for the progress bar.
  void Expect(std::size_t photographs) { expected_ = photographs; }
  /// Writes <name>.jpg, <name>.depth.tiff, <name>.order.tiff and <name>.lit.png and adds `truth` to the list.
  Status Photograph(const std::string& name, rig::TriangleMesh mesh, nlohmann::json truth);
  /// Writes a file beside the photographs; `name` is listed with them.
  Status WriteBeside(const std::string& name, const std::string& text);
  /// Writes calibration.json and truth.json; returns the document for --json.
  Result<nlohmann::json> Finish(const std::string& scene);

  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  [[nodiscard]] double distance_mm() const { return distance_mm_; }
  [[nodiscard]] unsigned seed() const { return static_cast<unsigned>(options_.render.sensor.seed); }

 private:
  [[nodiscard]] Result<nlohmann::json> PutLabels(rig::TriangleMesh& mesh) const;
  [[nodiscard]] rig::CameraTags Tags() const;

  SimulationOptions options_;
  Calibration calibration_;
  double distance_mm_ = 0;
  std::size_t expected_ = 1;
  nlohmann::json photographs_ = nlohmann::json::array(), files_ = nlohmann::json::array();
};

}  // namespace striae::app
