// A boundary proposed by colour and shape from a rough box or a few strokes; the operator confirms or edits it.
#pragma once

#include <string>
#include <vector>

#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::wound {

/// What the operator points at, in sensor pixels.
struct BoundaryHints {
  std::vector<Eigen::Vector2d> box;                         ///< two opposite corners of a rough box around the wound
  std::vector<std::vector<Eigen::Vector2d>> wound_strokes;  ///< lines that lie in the wound
  std::vector<std::vector<Eigen::Vector2d>> skin_strokes;   ///< lines that lie on healthy skin
};

struct BoundaryOptions {
  double cell_mm = 0.4;       ///< the colours and heights are averaged to cells of this size
  double margin_share = 0.6;  ///< skin that is looked at around the box, of its longer side
  double smoothing_mm = 1;    ///< sd along the line
  double refine_mm = 2;       ///< how far the edge may lie from the cells' border
};

struct BoundaryProposal {
  Outline outline;        ///< a simple line; image_sha256 from the surface where it says so
  double confidence = 0;  ///< 0..1: share of the line where the skin differs from the wound beside it by 2 sd or more
  double area_mm2 = 0;    ///< of the line in the surface's mean plane, for comparing proposals
};

/// Cells inside and outside are parted by GrabCut (Rother et al., ACM Trans Graph 2004, 23:309) on Lab's a* and b* and
/// on the depth below a quadric through the surrounding skin; then the line moves along its normals to where the
/// likeness of either side is equal, to a fraction of a cell, and is smoothed. Deterministic.
/// kUsage for hints that enclose nothing, kOutlineOffSurface where there is no surface, kMeasurementRefused where
/// nothing inside differs from the skin.
Result<BoundaryProposal> ProposeBoundary(const Surface& surface, const BoundaryHints& hints,
                                         const BoundaryOptions& options = {});

}  // namespace striae::wound
