// Trials: photographs that the virtual rig takes with parameters nobody told the code under test, and what became of
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquire/rig/default_rig.h"
#include "core/calibration.h"
#include "core/image.h"
#include "core/surface.h"

namespace striae::testing {

/// A rig of the range as another workshop might have built it: from the nominal one by a percent in focal length, 25 px
/// in the principal point, 5 mm in the projector's place, a fifth of a degree in its aim, 2 % in the grating's scale,
/// and with its own distortions.
Calibration UnknownRig(rig::Range range, std::uint32_t seed);
std::string NameOf(rig::Range range);

/// One photograph with its truth.
struct Shot {
  Photograph photograph;
  ImageF depth_mm;  ///< NaN where there is no surface
  Mask lit;         ///< by the stripes
};

/// Scenes that `striae simulate` renders into one folder. With STRIAE_TRIALS in the environment they are kept there and
/// used again (rendering takes longer than what is measured on them); otherwise they are rendered afresh and removed.
class Trials {
 public:
  /// `scale` is the sensor's, as `striae simulate --scale`.
  Trials(rig::Range range, std::uint32_t seed, double scale = 1);
  ~Trials();
  Trials(const Trials&) = delete;
  Trials& operator=(const Trials&) = delete;

  /// Folder of `striae simulate SCENE OPTIONS... --rig <this one>`. Throws std::runtime_error when that fails.
  std::filesystem::path Scene(const std::string& scene, const std::vector<std::string>& options = {});
  /// Photograph, depth and mask of a scene in that folder.
  static Shot Read(const std::filesystem::path& folder, const std::string& name);

  /// The report of `striae calibrate` on the reference plate's steps (nine 25 mm apart at 1 m, seven 50 mm apart at
  /// 2 m); the calibration is at calibration_file().
  std::string Calibrate();
  [[nodiscard]] std::filesystem::path calibration_file() const { return folder_ / "own.json"; }
  [[nodiscard]] Calibration Own() const;
  /// The truth, with the sensor scaled.
  [[nodiscard]] Calibration True() const { return rig::ScaleSensor(rig_, scale_); }
  [[nodiscard]] bool small() const { return range_ == rig::Range::kSmall; }

 private:
  rig::Range range_;
  double scale_;
  Calibration rig_;
  std::filesystem::path folder_;
  bool keep_ = false;
};

struct PointError {
  float error_mm = 0;        ///< measured less true depth
  float uncertainty_mm = 0;  ///< 0 where the surface gives none
  int col = 0, row = 0;
};
/// All points of the surface that have a true depth; none is left out.
std::vector<PointError> PointErrors(const Surface& surface, const ImageF& depth_mm);

struct ErrorFigures {
  std::size_t points = 0;
  double mean = 0, sd = 0;                        ///< of all
  double median = 0, median_abs = 0, p90_abs = 0; /**< of all; median of the errors, of their absolute values, and
                                                       the latter's 90th percentile */
};
ErrorFigures FiguresOf(const std::vector<PointError>& errors);

/// Share of the lit pixels that have a point.
double CoverageOf(const Surface& surface, const Mask& lit);

}  // namespace striae::testing
