#include "acquire/rig/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/optics.h"

namespace striae::rig {
namespace {

constexpr int kStepsPerStripe = 256;
constexpr double kReach = 2.0;   // a stripe's light ends within two stripes of its centre at the largest blur
constexpr double kLevel = 0.01;  // of blur, stripes
constexpr std::size_t kLevels = 51, kTable = static_cast<std::size_t>(2 * kReach * kStepsPerStripe) + 2;

double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace

int StripesOf(const Calibration& calibration, int otherwise) { return calibration.stripes.value_or(otherwise); }

GratingLight::GratingLight(int stripes) : stripes_(stripes), stripe_(kLevels * kTable) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    const double sigma = std::max(kLevel * static_cast<double>(level), 1e-6);
    for (std::size_t i = 0; i < kTable; ++i) {
      const double x = static_cast<double>(i) / kStepsPerStripe - kReach;
      stripe_[level * kTable + i] = NormalCdf((x + 0.25) / sigma) - NormalCdf((x - 0.25) / sigma);
    }
  }
}

double GratingLight::Table(std::size_t level, double place) const {
  const auto i = static_cast<std::size_t>(place);
  const double* stripe = stripe_.data() + level * kTable + i;
  return std::lerp(stripe[0], stripe[1], place - static_cast<double>(i));
}

double GratingLight::At(double order, double blur_stripes) const {
  if (!(order > -kReach && order < stripes_ - 1 + kReach)) return 0;
  const double blur = std::clamp(blur_stripes / kLevel, 0.0, static_cast<double>(kLevels - 1) - 1e-9);
  const auto level = static_cast<std::size_t>(blur);
  const int nearest = static_cast<int>(std::lround(order));
  const int neighbours = blur_stripes < 0.2 ? 1 : 2;  // at 0.2 stripes, 1.25 stripes off are six standard deviations
  double light = 0;
  for (int k = std::max(0, nearest - neighbours); k <= std::min(stripes_ - 1, nearest + neighbours); ++k) {
    const double place = (order - k + kReach) * kStepsPerStripe;
    if (place < 0 || place >= 2 * kReach * kStepsPerStripe) continue;
    light += std::lerp(Table(level, place), Table(level + 1, place), blur - static_cast<double>(level));
  }
  return std::min(light, 1.0);
}

double GratingBlur(const LightOptions& options, double focal_stripes, double distance_mm) {
  if (options.aperture_mm <= 0) return options.blur_stripes;
  const double disc = options.aperture_mm * focal_stripes * std::abs(1 / distance_mm - 1 / options.focus_mm);
  return std::hypot(options.blur_stripes, disc / 4);
}

ProjectorLight::ProjectorLight(const Calibration& calibration, int stripes, const LightOptions& options)
    : options_(options),
      projector_from_camera_(RotationFromRodrigues(calibration.projector.rotation_rodrigues)),
      center_mm_(calibration.projector.center_mm),
      focal_stripes_(calibration.projector.focal_stripes),
      k1_(calibration.projector.k1),
      half_width_stripes_(0.5 * stripes * options.mask_aspect),
      half_height_stripes_(0.5 * stripes),
      strength_mm2_(options.flash * options.reference_mm * options.reference_mm) {
  if (calibration.projector.kind == ProjectorModel::Kind::kAngular) {
    // A fan of planes: its middle plane stands for the axis, and its flat mask is as wide as the fan in the middle.
    const double middle = calibration.projector.a0_rad + 0.5 * (stripes - 1) * calibration.projector.delta_a_rad;
    const bool along_rows = calibration.direction == StripeDirection::kHorizontal;
    const Eigen::Vector3d about = along_rows ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
    projector_from_camera_ = Eigen::AngleAxisd(middle, about).toRotationMatrix();
    if (!along_rows) {  // n grows with the mask's second axis
      const Eigen::Matrix3d turned = projector_from_camera_;
      projector_from_camera_.row(0) = turned.row(1);
      projector_from_camera_.row(1) = turned.row(0);
    }
    focal_stripes_ = 1 / calibration.projector.delta_a_rad;
    k1_ = 0;
  }
}

double ProjectorLight::At(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d q = projector_from_camera_ * (point - center_mm_);
  if (q.z() <= 0) return 0;
  const double a = q.x() / q.z(), b = q.y() / q.z();
  const double across = std::abs(focal_stripes_ * a * (1 + k1_ * (a * a + b * b)));
  const double blur = std::max(GratingBlur(options_, focal_stripes_, q.norm()), 1e-6);
  const double mask = NormalCdf((half_width_stripes_ - across) / blur);
  const double place = focal_stripes_ * std::hypot(a, b) / half_height_stripes_;
  const double vignetting = 1 / (1 + 0.12 * place * place);
  return strength_mm2_ / q.squaredNorm() * mask * vignetting;
}

double ProjectorLight::BlurAt(const Eigen::Vector3d& point) const {
  return GratingBlur(options_, focal_stripes_, (point - center_mm_).norm());
}

}  // namespace striae::rig
