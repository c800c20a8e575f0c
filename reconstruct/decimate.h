// Fewer triangles for the same surface, and how far they are from it.
#pragma once

#include <cstddef>

#include "core/result.h"
#include "core/surface.h"

namespace striae::reconstruct {

/// Collapses edges, cheapest first, until at most `faces` triangles are left (Garland and Heckbert's plane quadrics
/// 1997, as CGAL has them; a collapse that turns a triangle over is passed by). Points are new: each takes colour,
/// quality and pixel of the nearest point of the input, so that texture coordinates stay within a pixel. Unchanged when
/// it has no more faces than that. kUsage for fewer than 4 faces; kMeasurementRefused for a surface without faces.
Result<Surface> Decimate(const Surface& surface, std::size_t faces);

struct Deviation {
  double largest_mm = 0, rms_mm = 0;
};
/// One-sided Hausdorff distance: from every point of `full` that has a face to the nearest place on the triangles of
/// `decimated`, its maximum and its root mean square.
Result<Deviation> DeviationFrom(const Surface& full, const Surface& decimated);

}  // namespace striae::reconstruct
