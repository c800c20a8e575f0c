// Reads the practice set's depth maps: depth (mm) at every 8th sensor pixel, uncompressed 32-bit TIFF.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/calibration.h"
#include "core/surface.h"

namespace striae::testing {

/// One vertex per valid depth, on its sensor pixel's ray, with Gaussian noise along the ray. Throws
/// std::runtime_error for anything but a little-endian uncompressed float map.
Surface SurfaceFromDepthMap(const std::filesystem::path& path, const CameraModel& camera, double noise_mm,
                            std::uint32_t seed);

}  // namespace striae::testing
