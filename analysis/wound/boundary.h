// A boundary proposed by colour and shape from a rough box or a few strokes; the operator confirms or edits it.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::wound {

/// What the operator points at, in sensor pixels.
struct BoundaryHints {
  std::vector<Eigen::Vector2d> box;                         ///< two opposite corners of a rough box around the wound
  std::vector<std::vector<Eigen::Vector2d>> wound_strokes;  ///< lines that lie in the wound
  std::vector<std::vector<Eigen::Vector2d>> skin_strokes;   ///< lines that lie on healthy skin
  Outline drawn;  ///< the whole outline, drawn within 2 mm of the edge: instead of a box
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
  double pixel_mm = 0;    ///< of the sensor on the surface there
};

/// Cells inside and outside are parted by GrabCut (Rother et al., ACM Trans Graph 2004, 23:309) on Lab's a* and b* and
/// on the depth below a quadric through the surrounding skin; then the line moves along its normals to where the
/// likeness of either side is equal, to a fraction of a cell, and is smoothed. Colours are the photograph's hues where
/// one is given (sensor orientation, the surface's size): it sees the walls that the surface lacks. Else they are the
/// surface's, and what it lacks beside deep cells is taken for the wound's wall. Deterministic.
/// kUsage for hints that enclose nothing or a photograph of another size, kOutlineOffSurface where there is no surface
/// or the outline was drawn on another photograph, kMeasurementRefused where nothing inside differs from the skin.
Result<BoundaryProposal> ProposeBoundary(const Surface& surface, const BoundaryHints& hints,
                                         const BoundaryOptions& options = {}, const ImageRgb* photograph = nullptr);

/// How far a proposal depends on how roughly the wound was pointed at.
struct BoundaryRepeatability {
  double shaken_mm = 0;      ///< sd of a hint's coordinates: 0.5 mm for a drawn outline, 1.5 mm for a box or strokes
  int tried = 0, found = 0;  ///< of the tries, how many gave a line at all
  double area_cv = 0;        ///< sd over mean of their areas
  double line_sd_mm = 0;     ///< rms distance of the proposed line's points from theirs
};

/// Proposes anew with every point of the hints moved by chance (Gaussian, the same each time it is asked).
BoundaryRepeatability RepeatBoundary(const Surface& surface, const BoundaryHints& hints,
                                     const BoundaryProposal& proposal, const BoundaryOptions& options = {},
                                     const ImageRgb* photograph = nullptr);

}  // namespace striae::wound
