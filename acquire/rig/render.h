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
  double lens_blur_px = 0.7;  ///< in focus, standard deviation on the full D90 sensor; shrinks with a scaled sensor
  double aperture_mm = 0;     ///< diameter of the lens' pupil, 50 mm / 11 for the D90's; 0: all depths are sharp
  double focus_mm = 1000;     ///< depth at which the lens is focused
  double iso = 400;
  double full_well_electrons = 30000;  ///< of a D90 pixel at ISO 200
  double read_noise_electrons = 6;
  bool noise = true;
  std::uint64_t seed = 1;
};

struct RenderOptions {
  LightOptions light;
  SensorOptions sensor;
  Eigen::Vector3d motion_mm = Eigen::Vector3d::Zero();  ///< of the body while the flash lights it; stripes stay
  int threads = 2;                                      ///< changes the time only, never a byte of the result
};

struct Rendering {
  ImageRgb photograph;  ///< sRGB, sensor orientation
  ImageF depth_mm;      ///< of the mesh along z at each pixel's centre, NaN where there is none
  ImageF order;         ///< stripe order at each pixel's centre where `lit`, else NaN
  Mask lit;             ///< 1 where the projector's centre sees the point and its order lies within the grating
};

/// Photographs `mesh` (camera frame) with the rig that `calibration` describes: lens and projector distortion, grating
/// with focus blur, fall-off, hard shadows, ambient light, motion, lens blur and defocus, shot and read noise,
/// saturation, sRGB. Depth, order and mask are those of the middle of the exposure.
/// kUsage for an empty mesh or options that cannot be meant; kInternal when Embree fails.
Result<Rendering> Render(const TriangleMesh& mesh, const Calibration& calibration, const RenderOptions& options);

}  // namespace striae::rig
