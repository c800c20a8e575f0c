// Small pictures of a capture for people: what `process` keeps beside a surface (kinds "preview-photo" and
// "preview-depth"), what `reconstruct --preview` writes, and what reports show. Nothing is measured from them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

/// Depth along the camera's z, mm; near is the colour bar's top.
struct DepthRange {
  double near_mm = 0, far_mm = 0;
};

/// The 1st and 99th percentile of the surface's depth, rounded outwards to whole millimetres, so that a few stray
/// points do not flatten the colours. kMeasurementRefused when the surface has no points.
Result<DepthRange> RobustDepthRange(const Surface& surface);

/// PNG (RGB, 8 bit) of the photograph in sensor orientation, its longer side scaled down (never up) to `max_side_px` by
/// averaging whole areas. kBadImage when it is empty.
Result<std::vector<std::uint8_t>> PhotographPreview(const ImageRgb& photograph, int max_side_px = 1600);

/// PNG of the depth map: viridis over `range` (robust when not given; give one range to compare visits), sensor
/// orientation, cut to the part that has points with a small margin, a labelled colour bar in mm at the right. Depth
/// outside the range takes the end colours. The picture is at most `max_side_px` wide and high, bar included.
/// kMeasurementRefused when the surface has no points, kUsage for an empty range.
Result<std::vector<std::uint8_t>> DepthPreview(const Surface& surface, std::optional<DepthRange> range = std::nullopt,
                                               int max_side_px = 1200);

/// PNG of the surface lit from the upper left (Lambert, grey clay), same cut and scale as DepthPreview without a bar:
/// shows holes, steps and noise that a photograph hides. Errors as DepthPreview.
Result<std::vector<std::uint8_t>> ShadedPreview(const Surface& surface, int max_side_px = 1200);

}  // namespace striae::app
