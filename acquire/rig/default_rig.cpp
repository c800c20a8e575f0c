#include "acquire/rig/default_rig.h"

#include <cmath>

namespace striae::rig {
namespace {
constexpr int kSensorWidth = 4288, kSensorHeight = 2848;
}  // namespace

RigNominal DefaultRig(Range range) {
  const bool small = range == Range::kSmall;
  RigNominal rig;
  rig.distance_mm = small ? 1000 : 2000;
  Calibration& c = rig.calibration;
  c.image_width_px = kSensorWidth;
  c.image_height_px = kSensorHeight;
  // A 50 mm lens focused at the range's distance on pixels of 5.5 um, and a lens' small imperfections.
  c.camera = small ? CameraModel{9581.6, 9577.9, 2155.4, 1415.3, -0.041, 0.03, 1.1e-4, -0.8e-4}
                   : CameraModel{9331.7, 9328.2, 2155.4, 1415.3, -0.043, 0.03, 1.1e-4, -0.8e-4};
  c.projector.center_mm = {3.8, -109.4, 44.7};
  // Tilted so that the grating's middle meets the camera's axis at the range's distance.
  c.projector.rotation_rodrigues = {small ? 0.1139 : 0.0558, 0.0041, -0.0027};
  c.projector.focal_stripes = small ? 525.3 : 259.6;
  c.projector.center_order = small ? 69.31 : 32.87;
  c.projector.k1 = -0.019;
  c.stripes = small ? 140 : 67;
  c.near_mm = small ? 850 : 1700;
  c.far_mm = small ? 1150 : 2300;
  return rig;
}

Calibration ScaleSensor(const Calibration& calibration, double scale) {
  Calibration c = calibration;
  c.image_width_px = static_cast<int>(std::lround(calibration.image_width_px * scale));
  c.image_height_px = static_cast<int>(std::lround(calibration.image_height_px * scale));
  // Integer coordinates are pixel centres, so the sensor's corner is at -0.5.
  c.camera.fx *= scale;
  c.camera.fy *= scale;
  c.camera.cx = (calibration.camera.cx + 0.5) * scale - 0.5;
  c.camera.cy = (calibration.camera.cy + 0.5) * scale - 0.5;
  return c;
}

}  // namespace striae::rig
