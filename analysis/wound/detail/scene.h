// Puts a surface and an outline into the wound's own frame.
#pragma once

#include <string>
#include <vector>

#include "analysis/wound/detail/line.h"
#include "analysis/wound/detail/report.h"
#include "analysis/wound/detail/ring.h"

namespace striae::wound {

struct ScenePlus {
  Scene scene;
  LineStudy line;             ///< of the outline as drawn, mm
  double hole_share = 0;      ///< cells inside the outline that had no measured point
  double boundary_share = 1;  ///< cells just outside the outline that belong to the skin's sheet
};

/// kOutlineOffSurface where the outline was drawn on another photograph than the surface was made from, if both say so.
Status CheckPhotograph(const Surface& surface, const Outline& outline);

/// Checks, cuts out, fills holes, finds the frame and lays the outline on the skin. Errors as Measure().
Result<ScenePlus> BuildScene(const Surface& surface, const Outline& outline, const Options& options);

/// The same frame and outline over cells of `cell_mm`, out to `reach_mm` from the outline: for looking at intact skin.
Result<Scene> CoarseScene(const Surface& surface, const Outline& outline, const Scene& fine, double cell_mm,
                          double reach_mm);

}  // namespace striae::wound
