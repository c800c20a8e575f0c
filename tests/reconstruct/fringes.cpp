#include "tests/reconstruct/fringes.h"

#include <cmath>
#include <limits>
#include <random>

#include "core/optics.h"

namespace striae::testing {
namespace {

/// A square wave whose edges are softened by the projector's focus; bright from -0.25 to 0.25.
double Grating(double order) {
  constexpr double kSoftness = 0.06;  // stripes
  const double from_center = std::abs(order - std::round(order));
  return 0.5 * std::erfc((from_center - 0.25) / kSoftness);
}

double SrgbEncoded(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// Projector light at a point, before noise; integrated over the pixel by three samples along the column.
double Light(const FringeScene& scene, const StripeOptics& optics, double col, double row) {
  double sum = 0;
  for (const double shift : {-1.0 / 3, 0.0, 1.0 / 3}) {
    const Eigen::Vector3d ray = RayOf(scene.rig.camera, {col, row + shift});
    const auto z = scene.depth(ray);
    if (!z) continue;
    const Eigen::Vector3d point = *z * ray;
    const auto order = optics.OrderAt(point);
    const bool lit = order && (!scene.rig.stripes || (*order > -0.25 && *order < *scene.rig.stripes - 0.75));
    sum += scene.albedo(point) * (scene.ambient + (lit ? Grating(*order) : 0)) / 3;
  }
  return sum;
}

}  // namespace

Calibration SmallQuarterRig() {
  Calibration rig;
  rig.image_width_px = 1072;
  rig.image_height_px = 712;
  rig.camera = {2390, 2388, 537.2, 353.4, -0.05, 0.04, 1e-4, -2e-4};
  rig.projector.center_mm = {4, -116, 41};
  rig.projector.rotation_rodrigues = {0.119, 0.003, -0.005};
  rig.projector.focal_stripes = 131;  // a quarter of the stripes keeps their width on the quarter-size sensor
  rig.projector.center_order = 17.2;
  rig.projector.k1 = -0.025;
  rig.stripes = 35;
  rig.near_mm = 850;
  rig.far_mm = 1150;
  return rig;
}

Calibration LargeQuarterRig() {
  Calibration rig = SmallQuarterRig();
  rig.camera.fx = 2330;
  rig.camera.fy = 2331;
  rig.projector.rotation_rodrigues = {0.0595, 0.002, -0.004};
  rig.projector.focal_stripes = 129;
  rig.projector.center_order = 16.4;
  rig.stripes = 34;
  rig.near_mm = 1700;
  rig.far_mm = 2300;
  return rig;
}

Photograph Render(const FringeScene& scene) {
  const StripeOptics optics(scene.rig);
  std::mt19937 engine(scene.seed);
  std::normal_distribution<double> noise(0, scene.noise);
  Photograph photograph{ImageF(scene.rig.image_width_px, scene.rig.image_height_px),
                        ImageRgb(scene.rig.image_width_px, scene.rig.image_height_px), 1.0F};
  for (int row = 0; row < photograph.luminance.height(); ++row) {
    for (int col = 0; col < photograph.luminance.width(); ++col) {
      const double light = 0.9 * Light(scene, optics, col, row) + noise(engine);
      const auto byte = static_cast<std::uint8_t>(std::lround(255 * SrgbEncoded(light)));
      photograph.luminance(col, row) = static_cast<float>(byte) / 255;
      photograph.colour(col, row) = {byte, byte, byte};
    }
  }
  return photograph;
}

ImageF TrueDepth(const FringeScene& scene) {
  ImageF depth(scene.rig.image_width_px, scene.rig.image_height_px, std::numeric_limits<float>::quiet_NaN());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      const auto z = scene.depth(RayOf(scene.rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (z) depth(col, row) = static_cast<float>(*z);
    }
  }
  return depth;
}

std::function<std::optional<double>(const Eigen::Vector3d&)> Plane(double distance_mm, double slope_x, double slope_y,
                                                                   double half_width_mm, double half_height_mm) {
  return [=](const Eigen::Vector3d& ray) -> std::optional<double> {
    const double z = distance_mm / (1 - slope_x * ray.x() - slope_y * ray.y());
    if (std::abs(z * ray.x()) > half_width_mm || std::abs(z * ray.y()) > half_height_mm) return std::nullopt;
    return z;
  };
}

std::function<std::optional<double>(const Eigen::Vector3d&)> UprightLimb(double distance_mm, double radius_mm) {
  return [=](const Eigen::Vector3d& ray) -> std::optional<double> {
    // |(z x, z - axis)| = radius with the axis behind the front by one radius.
    const double axis = distance_mm + radius_mm, a = 1 + ray.x() * ray.x();
    const double discriminant = axis * axis - a * (axis * axis - radius_mm * radius_mm);
    if (discriminant < 0) return std::nullopt;
    return (axis - std::sqrt(discriminant)) / a;
  };
}

}  // namespace striae::testing
