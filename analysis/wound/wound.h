// Wound measurement: the healthy skin around an outline is continued across it (the virtual skin), and the wound is
// what lies between that skin and the measured surface. Method, equations and limits: docs/wound.md.
#pragma once

#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/measurement.h"
#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::wound {

/// How a wound is measured. All lengths in mm, so that scaling them with the surface scales the results.
struct Options {
  double cell_mm = 0.3;    ///< pixels are averaged to cells of about this size; never finer than the sensor's pixels
  double margin_mm = 1.0;  ///< volume is integrated this far outside the drawn line (harmless outside, harmful inside)
  /// Where the ring of healthy skin may begin, outwards from the line; the first without a radial trend is taken.
  std::vector<double> gaps_mm = {2, 3, 4, 6, 8, 10, 12, 15, 18};
  double ring_width_mm = 12;
  double radial_trend_mm = 0.05;  ///< step between the ring's inner edge and its middle that counts as oedema
  double null_cell_mm = 1.0;      ///< cells for looking at intact skin beside the wound
  double smoothing_mm = 0.5;      ///< sd of the Gaussian before depth and bed area; volume stays unsmoothed
  double deepest_mm = 1.25;       ///< radius of the surface fitted around the deepest point
  /// Sd of the reconstruction's kernel where the surface does not say its carrier period: stripes 1.9 mm apart. Else
  /// T / (sqrt(2) pi) for stripes T apart on the skin.
  double resolution_mm = 0.43;
  double perimeter_step_mm = 1.0;  ///< the outline is resampled at this step and draped on the virtual skin
  double max_ring_slope_deg = 60;  ///< steeper skin (against the ring's mean plane) cannot be continued by polynomials
  double outline_sd_mm = 0.05;     /**< standard uncertainty of the drawn line's place, as a common offset: half a
                                        pixel at 1 m. The line's own shakes are added; what an operator would take for
                                        the edge on another day is not in it */
  /// For surfaces that name no uncertainties: of the place of a wound's walls, which the Fourier stage rounds, and of
  /// the rim's cross-section as a share of the kernel's variance (it weighs by light, and skin reflects more than bed).
  double wall_sd_mm = 0.01, rim_share = 0.15;
  double bridge_mm = 2;              ///< holes inside the wound are bridged up to this far from a measured point
  double scale_relative_sd = 0.001;  ///< standard uncertainty of the surface's scale (calibration)
};

/// Heights along a straight cut through the wound's frame, mm; NaN where no bed was measured.
struct WoundSection {
  std::vector<double> along_mm, skin_mm, bed_mm;
};

/// For pictures.
struct WoundMaps {
  int col0_px = 0, row0_px = 0, cell_px = 1;  ///< sensor pixels of the map's first cell and of a cell's side
  double cell_mm = 0;
  ImageF depth_mm;            ///< below the virtual skin (above it negative); NaN where nothing was measured
  ImageF u_mm, v_mm, bed_mm;  ///< the same cells in the wound's frame, w towards the camera; NaN likewise
  ImageF skin_mm;             ///< height of the virtual skin there
  std::vector<Eigen::Vector3d> boundary_mm;  ///< the line draped on the virtual skin, same frame
  WoundSection longest, across;              ///< along the longest axis, and across its middle
};

/// Version of the method: changes whenever a number may change.
std::string_view MethodVersion();

/// Measures the wound inside `outline` (sensor pixels) on `surface` (mm, camera frame; must carry sensor col and row).
/// Quantities, units and flags as CONTRACT has them: volume, proud_volume mL; area, bed_area cm2; perimeter, depth_max,
/// depth_p95, depth_mean, length, width mm. Uncertainties are standard uncertainties. The report's provenance holds
/// the parameters; the caller adds the inputs. Deterministic; single-threaded.
/// Errors: kBadFile (surface without sensor pixels, outline with fewer than three points, not finite or self-crossing),
/// kOutlineOffSurface (drawn on another photograph, boundary off the sensor, off the surface or across its edge),
/// kMeasurementRefused (wound too small, hole inside it, too little or too steep healthy skin around it), kUsage
/// (options that cannot be meant). `maps`, where given, is filled with what pictures show.
Result<AnalysisReport> Measure(const Surface& surface, const Outline& outline, const Options& options = {},
                               WoundMaps* maps = nullptr);

}  // namespace striae::wound
