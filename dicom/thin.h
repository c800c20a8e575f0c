// A surface with fewer faces for a PACS, and how far it is from what was measured.
#pragma once

#include <cstddef>

#include "core/result.h"
#include "core/surface.h"

namespace striae::dicom {

constexpr std::size_t kMostFaces = 200'000;

struct ThinnedSurface {
  Surface surface;
  int step = 1;                 ///< every step-th column and row of the sensor is kept; 1 = unchanged
  double deviation_max_mm = 0;  ///< of the left-out points from the triangle that now covers them
  double deviation_p95_mm = 0;
  double uncovered_share = 0;  ///< share of all points over which there is no triangle any more (at rims and cuts)
};

/// Keeps every k-th sensor pixel, k from the ratio of the numbers of faces, and meshes those anew. A coarse
/// triangle stands only where its three corners hang together in the full mesh within its own k x k pixels, so that a
/// cut (a step in depth that the reconstruction did not bridge) stays a cut, while single missing pixels are bridged.
/// The deviation is measured at every left-out point, to the triangle that its own ray goes through.
/// kUsage when faces must be left out but the surface does not know its pixels; kMeasurementRefused without faces.
Result<ThinnedSurface> ThinSurface(const Surface& surface, std::size_t most_faces = kMostFaces);

}  // namespace striae::dicom
