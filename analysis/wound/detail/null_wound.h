// Null wounds: the same outline laid on intact skin nearby must measure about zero. What it measures instead says which
// model of the skin suits this body, and how far the chosen one may be off.
#pragma once

#include <array>
#include <vector>

#include "analysis/wound/detail/ring.h"
#include "analysis/wound/wound.h"

namespace striae::wound {

/// One place of intact skin.
struct NullWound {
  Eigen::Vector2d shift_mm;                                      ///< of the outline in the wound's frame
  std::array<std::optional<double>, kSkinModels.size()> mean_mm; /**< mean height of each model's skin above the
                                                                      measured one; none where it does not fit */
  double deepest_mm = 0;  ///< largest height of the first model's skin above or below it, smoothed by the cells
};

struct IntactSkin {
  std::vector<NullWound> wounds;
  /// Root mean square of the model's mean heights; none when it was tried in fewer than `least` places.
  [[nodiscard]] std::optional<double> Rms(std::size_t model, std::size_t least = 1) const;
};

/// Lays the outline of `scene` beside itself in up to eight directions, as near as its ring and the wound's swollen
/// skin (within `gap_mm` of the line) allow, on `coarse`: a scene of the same frame and outline with large cells that
/// reaches further. Places without a sufficient ring are left out; none may be left.
IntactSkin TryIntactSkin(const Scene& coarse, double gap_mm, double ring_width_mm, double max_slope_deg);

}  // namespace striae::wound
