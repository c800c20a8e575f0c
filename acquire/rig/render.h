// One photograph of a mesh under the flash-lit grating, with the truth beside it.
#pragma once

#include <cstdint>

#include "acquire/rig/light.h"
#include "acquire/rig/mesh.h"
#include "core/calibration.h"
#include "core/image.h"
#include "core/result.h"

namespace striae::rig {

struct SensorOptions {
  double lens_blur_px = 0.7;  ///< standard deviation on the full D90 sensor; shrinks with a scaled sensor
  double iso = 400;
  double full_well_electrons = 30000;  ///< of a D90 pixel at ISO 200
  double read_noise_electrons = 6;
  bool noise = true;
  std::uint64_t seed = 1;
};

struct RenderOptions {
  LightOptions light;
  SensorOptions sensor;
  int threads = 2;  ///< changes the time only, never a byte of the result
};

struct Rendering {
  ImageRgb photograph;  ///< sRGB, sensor orientation
  ImageF depth_mm;      ///< of the mesh along z at each pixel's centre, NaN where there is none
  Mask lit;             ///< 1 where the projector's centre sees the point and its order lies within the grating
};

/// Photographs `mesh` (camera frame) with the rig that `calibration` describes: lens and projector distortion, grating
/// with focus blur, fall-off, hard shadows, ambient light, lens blur, shot and read noise, saturation, sRGB.
/// kUsage for an empty mesh or options that cannot be meant; kInternal when Embree fails.
Result<Rendering> Render(const TriangleMesh& mesh, const Calibration& calibration, const RenderOptions& options);

}  // namespace striae::rig
