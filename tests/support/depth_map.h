// The practice set's true depths: millimetres at every 8th sensor pixel, another program's uncompressed 32-bit TIFF.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/calibration.h"
#include "core/image.h"
#include "core/surface.h"

namespace striae::testing {

/// Every `kDepthMapStep_px`-th pixel of the sensor, both ways, has a depth.
constexpr int kDepthMapStep_px = 8;

/// 0 or NaN where nothing was seen. Throws std::runtime_error for anything but a little-endian uncompressed float map.
ImageF ReadDepthMap(const std::filesystem::path& path);

/// One vertex per valid depth, on its sensor pixel's ray, with Gaussian noise along the ray; `col` and `row` count the
/// map's pixels. No colour, no quality. Throws as ReadDepthMap.
Surface SurfaceFromDepthMap(const std::filesystem::path& path, const CameraModel& camera, double noise_mm = 0,
                            std::uint32_t seed = 0);

}  // namespace striae::testing
