// What `striae calibrate` does with a reference object: photographs measured, the rig solved, every surface compared.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/io/difference_map.h"
#include "app/progress.h"
#include "core/hex.h"
#include "core/study.h"
#include "reconstruct/calibrate/board.h"
#include "reconstruct/calibrate/photographs.h"
#include "reconstruct/calibrate/steps.h"
#include "reconstruct/order.h"

namespace striae::app {

struct CalibratingOptions {
  std::filesystem::path reference, steps, out, map;
  std::vector<std::filesystem::path> board;  ///< photographs of the printed board, instead of reference and steps
  RigRange range = RigRange::kSmall;         ///< which board was printed
  int stripes = 0;
  double period_um = 0, distance_mm = 0;
  double sensor_width_mm = 23.6;   ///< the D90's
  double projector_focal_mm = 25;  ///< the C-mount lens
  reconstruct::SolveOptions solve;
};

/// A photograph with what calibration asks of its file.
struct CalibrationPhotograph {
  Photograph photograph;
  Sha256 sha256;
  std::optional<double> focal_length_mm;  ///< EXIF
};
Result<CalibrationPhotograph> OpenForCalibration(const std::filesystem::path& path);

/// One photograph before and after the solution.
struct Shot {
  std::string image;
  std::filesystem::path path;
  Sha256 sha256;
  double carrier_period_px = 0;
  double modulation = 0;  ///< median over the valid pixels
  reconstruct::Spread spread;
  double coverage = 0;
  reconstruct::OrderSource order_source = reconstruct::OrderSource::kNone;
  double order_margin = 0;
};

/// Everything between reading and writing.
struct Calibrating {
  std::vector<Shot> shots;
  std::vector<reconstruct::CalibrationView> views;
  reconstruct::NominalRig nominal;
  double nearest_position_mm = 0;  ///< smallest of the steps
  std::vector<DifferencePanel> panels;
  reconstruct::Spread all;
  double coverage = 0;
};

/// The rig as the options describe it; the camera is adopted from the first photograph.
reconstruct::NominalRig NominalOf(const CalibratingOptions& options, double nearest_mm);
/// The first photograph says what the camera is; the others must be of its size.
Status AdoptCamera(const CalibrationPhotograph& opened, bool first, const CalibratingOptions& options,
                   reconstruct::NominalRig& nominal);
/// Median modulation of the valid pixels.
double ModulationOf(const reconstruct::PhaseResult& phase);
/// kBadCalibration for a photograph whose stripes are much fainter than the others': out of focus, or shaken.
Status CheckSharpness(const std::vector<Shot>& shots);

Result<reconstruct::ReferenceShape> ReadReference(const std::filesystem::path& path);
Result<std::vector<reconstruct::CalibrationStep>> ReadSteps(const std::filesystem::path& path);

/// Phase and samples of every photograph. Refuses at once a photograph that cannot belong to the others or to the mesh.
Status MeasureAll(const std::vector<reconstruct::CalibrationStep>& steps, const CalibratingOptions& options,
                  const reconstruct::ReferenceShape& shape, ProgressBar& bar, Calibrating& work);
/// The rig from photographs of the printed board, with the report of --json less its time. Writes nothing.
struct BoardCalibrated {
  reconstruct::BoardFit fit;
  nlohmann::json report;
};
Result<BoardCalibrated> CalibrateWithBoard(const CalibratingOptions& options);

/// Reconstructs every photograph with the calibration found and compares it with the posed reference.
Status Evaluate(const reconstruct::ReferenceShape& shape, const reconstruct::CalibrationFit& fit, ProgressBar& bar,
                Calibrating& work);

/// The report of --json.
nlohmann::json ReportOf(const Calibrating& work, const reconstruct::CalibrationFit& fit,
                        const CalibratingOptions& options, double seconds);
/// "parameters", "correlations" and "warnings", for either way of calibrating.
void AddParameters(const std::vector<reconstruct::CalibrationFit::Parameter>& parameters,
                   const std::vector<reconstruct::CalibrationFit::Correlation>& correlations, bool order_is_absolute,
                   nlohmann::json& document);

}  // namespace striae::app
