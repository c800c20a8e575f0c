// The uncertainty budget of one wound: what each quantity owes to the ring, the model, the gap, the line and the scale.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "analysis/wound/detail/choice.h"
#include "analysis/wound/detail/deepest.h"
#include "analysis/wound/detail/line.h"
#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/report.h"

namespace striae::wound {

/// Everything that was measured, before uncertainties.
struct Findings {
  double net_mm3 = 0;              ///< under the skin minus above it, with the margin
  double noise_mm = 0;             ///< robust sd of the smoothed ring about the skin
  double stripe_mm = 0;            ///< distance of the stripes on the skin
  double resolution_mm = 0;        ///< sd of the reconstruction's kernel on the skin
  double skin_uncertainty_mm = 0;  ///< the surface's own, median over the ring
  Depths depths;
  Deepest deepest;
  LineStudy line;
  Boundary boundary;
};

struct Budget {
  Figures figures;
  nlohmann::json models = nlohmann::json::array();  ///< what each model of the skin gives
  nlohmann::json volume_parts_ml;                   ///< standard uncertainties of the volume, by cause
  nlohmann::json depth_parts_mm;                    ///< the same of the greatest depth
};

/// Values with standard uncertainties; adds flags where the volume is doubtful.
Budget DrawBudget(const Scene& scene, const Bed& bed, const Choice& choice, const ModelChoice& model,
                  const IntactSkin& intact, const Findings& findings, const Options& options, Flags& flags);

}  // namespace striae::wound
