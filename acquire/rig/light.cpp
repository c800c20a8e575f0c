#include "acquire/rig/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/optics.h"

namespace striae::rig {
namespace {

constexpr int kStepsPerStripe = 512;
constexpr double kReach = 1.0;  // a stripe's light ends within one stripe of its centre at any sane blur

double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace

int StripesOf(const Calibration& calibration, int otherwise) { return calibration.stripes.value_or(otherwise); }

GratingLight::GratingLight(int stripes, double blur_stripes) : stripes_(stripes) {
  const double sigma = std::max(blur_stripes, 1e-6);
  const int count = static_cast<int>(2 * kReach * kStepsPerStripe) + 2;
  table_.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / kStepsPerStripe - kReach;
    table_[static_cast<std::size_t>(i)] = NormalCdf((x + 0.25) / sigma) - NormalCdf((x - 0.25) / sigma);
  }
}

double GratingLight::At(double order) const {
  if (!(order > -kReach && order < stripes_ - 1 + kReach)) return 0;
  const int nearest = static_cast<int>(std::lround(order));
  double light = 0;
  for (int k = std::max(0, nearest - 1); k <= std::min(stripes_ - 1, nearest + 1); ++k) {
    const double place = (order - k + kReach) * kStepsPerStripe;
    if (place < 0 || place >= 2 * kReach * kStepsPerStripe) continue;
    const auto i = static_cast<std::size_t>(place);
    light += std::lerp(table_[i], table_[i + 1], place - static_cast<double>(i));
  }
  return std::min(light, 1.0);
}

ProjectorLight::ProjectorLight(const Calibration& calibration, int stripes, const LightOptions& options)
    : projector_from_camera_(RotationFromRodrigues(calibration.projector.rotation_rodrigues)),
      center_mm_(calibration.projector.center_mm),
      focal_stripes_(calibration.projector.focal_stripes),
      k1_(calibration.projector.k1),
      half_width_stripes_(0.5 * stripes * options.mask_aspect),
      half_height_stripes_(0.5 * stripes),
      blur_stripes_(std::max(options.blur_stripes, 1e-6)),
      strength_mm2_(options.flash * options.reference_mm * options.reference_mm) {
  if (calibration.projector.kind == ProjectorModel::Kind::kAngular) {  // a fan looks along the camera's axis
    focal_stripes_ = 1 / calibration.projector.delta_a_rad;
    k1_ = 0;
  }
}

double ProjectorLight::At(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d q = projector_from_camera_ * (point - center_mm_);
  if (q.z() <= 0) return 0;
  const double a = q.x() / q.z(), b = q.y() / q.z();
  const double across = std::abs(focal_stripes_ * a * (1 + k1_ * (a * a + b * b)));
  const double mask = NormalCdf((half_width_stripes_ - across) / blur_stripes_);
  const double place = focal_stripes_ * std::hypot(a, b) / half_height_stripes_;
  const double vignetting = 1 / (1 + 0.12 * place * place);
  return strength_mm2_ / q.squaredNorm() * mask * vignetting;
}

}  // namespace striae::rig
