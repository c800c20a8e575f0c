// From a photograph under stripes to its unwrapped phase. Needs no calibration: any fringe photograph will do.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/image.h"
#include "core/result.h"
#include "reconstruct/misfit.h"
#include "reconstruct/unwrap.h"

namespace striae::reconstruct {

/// The window over the stripes' frequencies, from f0 (1 - half_width) to f0 (1 + half_width). Wider keeps edges,
/// narrower removes noise. A window that is round at its top, as Hann's h (the paper's), rounds the phase wherever the
/// period changes; 1 - (1 - h)^2 is flat there: what h takes off is looked for once more in what it left over (van
/// Cittert's deconvolution, one step).
struct BandWindow {
  double half_width = 0.7;
  bool flattened = true;
};

struct PhaseOptions {
  std::optional<StripeDirection> direction;  ///< found when not given
  BandWindow window;
  /// The local mean is subtracted before the transform, so that its steps do not reach into the window.
  bool remove_background = true;
  /// Smoothing along the stripes (standard deviation of a Gaussian, in periods): with `window` it makes a window
  /// in two dimensions. Across the stripes the window reaches much farther, so that no detail is lost.
  double smoothing_along = 0;
  /// Most of the light that the stripes may leave unexplained (PhaseResult::MisfitAt): more is left at a silhouette, a
  /// step or a fold that the window cannot follow, and the phase is off by about as much.
  double most_misfit = 0.16;
  /// The same against the photograph's median: noise and texture leave more everywhere.
  double most_misfit_times = 3;
  /// Least amplitude against the local plateau (three periods along the line). At a silhouette it falls to half.
  double least_plateau_share = 0.3;
  double least_modulation = 0.08;  ///< amplitude over background
  /// Least modulation against that of the well lit parts (upper quartile): what no stripe reaches still shows a ghost
  /// of the carrier along its outline, on dark and bright surfaces alike.
  double least_modulation_share = 0.35;
  /// Most modulation against that of the well lit parts, or most_modulation where that is more: light that spills from
  /// a bright neighbour into a shadow brings its stripes, but not its mean. Such a place has its neighbour's phase.
  double most_modulation_share = 1.1;
  double most_modulation = 0.94;
  double least_run_periods = 1.0;  ///< along a line across the stripes: a step of brightness gives a shorter ghost
  /// Taken off where the stripes end, along the line: there the window sees more dark than stripes, and the errors are
  /// three to ten times those further in.
  double rim_periods = 0.06;
  double largest_phase_noise = 0.35;  ///< rad, standard deviation expected from the sensor's noise
  int least_region_px = 400;          ///< smaller specks are dropped
};

struct PhaseResult {
  StripeDirection direction = StripeDirection::kHorizontal;
  double carrier_period_px = 0, carrier_prominence = 0;
  /// All of the photograph's size, sensor orientation.
  Unwrapped unwrapped;             ///< increases with the row (horizontal stripes) or the column (vertical)
  ImageF amplitude;                ///< of the fundamental, linear light, full scale 1
  ImageF background;               ///< local mean, linear light
  Mask mask;                       ///< where stripes are; what misfits among them still tells one surface from the next
  Image<std::uint8_t> misfit;      ///< as KeptMisfit keeps it
  std::uint8_t most_misfit = 255;  ///< what is more is no measurement
  float usual_misfit = 0;          ///< lower quartile where stripes are: noise, texture, harmonics
  double noise = 0;                ///< sd of the amplitude's components; phase noise (rad) = noise / amplitude
  double saturated_share = 0;      ///< of the pixels

  /// Amplitude over background, 0..1, of pixel `i` (row-major).
  [[nodiscard]] float ModulationAt(std::size_t i) const {
    return Modulation(amplitude.pixels()[i], background.pixels()[i]);
  }
  /// sqrt(1 - r^2) around pixel `i`, r being the correlation of the light with the stripes found in it: 0 to 1.
  [[nodiscard]] float MisfitAt(std::size_t i) const { return MisfitOf(misfit.pixels()[i]); }
  [[nodiscard]] bool FitsAt(std::size_t i) const { return misfit.pixels()[i] <= most_misfit; }
  [[nodiscard]] bool FitsAt(int col, int row) const { return misfit(col, row) <= most_misfit; }
  static float Modulation(float amplitude, float background) {
    return std::clamp(amplitude / std::max(background, 1e-6F), 0.0F, 1.0F);
  }
};

/// kBadImage for a photograph too small, kNoCarrier when no stripes are found or none are bright enough to carry phase.
Result<PhaseResult> MeasurePhase(const Photograph& photograph, const PhaseOptions& options = {});
/// The same in the memory of the photograph's luminance, which is gone afterwards; its colour stays.
Result<PhaseResult> MeasurePhase(Photograph&& photograph, const PhaseOptions& options = {});

/// The stripes' own period (px) along the line where it is measured: it follows slope and distance. 5th and 95th
/// percentile over steps of half a carrier period; zeros where nothing is measured.
struct LocalPeriods {
  double fifth_px = 0, ninety_fifth_px = 0;
};
LocalPeriods FollowPeriod(const PhaseResult& phase);

/// The mask without the pixels whose light does not fit: where the phase is a measurement.
Mask MeasuredMask(const PhaseResult& phase);

}  // namespace striae::reconstruct
