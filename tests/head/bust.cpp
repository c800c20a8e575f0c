#include "tests/head/bust.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

namespace striae::testing {
namespace {

using Eigen::Vector3d;

/// Union with a rounded seam of width k (polynomial smooth minimum).
double Blend(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

/// First-order distance of an ellipsoid with the given half axes.
double Ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& half) {
  const Vector3d q = p - centre;
  const double k0 = q.cwiseQuotient(half).norm(), k1 = q.cwiseQuotient(half.cwiseProduct(half)).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -half.minCoeff();
}

double Capsule(const Vector3d& p, const Vector3d& a, const Vector3d& b, double radius) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - radius;
}

/// Skull, brow, nose, cheeks, ears, chin; origin in the middle of the neck.
double Head(const Vector3d& p, double jaw_drop_mm) {
  double d = Ellipsoid(p, {10, 130, 0}, {95, 112, 75});
  d = Blend(d, Ellipsoid(p, {35, 60 - jaw_drop_mm, 0}, {55, 42, 48}), 30);  // jaw and chin
  d = Blend(d, Ellipsoid(p, {92, 152, 0}, {14, 9, 45}), 14);                // brow
  d = -Blend(-d, Ellipsoid(p, {104, 136, 33}, {14, 11, 17}), 10);           // eye sockets
  d = -Blend(-d, Ellipsoid(p, {104, 136, -33}, {14, 11, 17}), 10);
  d = Blend(d, Capsule(p, {100, 140, 0}, {116, 104, 0}, 9), 10);  // nose
  d = Blend(d, Ellipsoid(p, {78, 112, 38}, {20, 15, 18}), 14);    // cheek bones
  d = Blend(d, Ellipsoid(p, {78, 112, -38}, {20, 15, 18}), 14);
  d = Blend(d, Ellipsoid(p, {5, 118, 76}, {16, 30, 9}), 5);  // ears
  return Blend(d, Ellipsoid(p, {5, 118, -76}, {16, 30, 9}), 5);
}

double Torso(const Vector3d& p, double breath_mm, double shrug_mm) {
  const double chest = 95 + breath_mm;
  double d = Ellipsoid(p, {-20, -210, 0}, {chest, 260, 165});
  d = Blend(d, Ellipsoid(p, {40, -130, 75}, {48, 60, 70}), 40);  // pectorals, with the breastbone's furrow between
  d = Blend(d, Ellipsoid(p, {40, -135, -75}, {48, 60, 70}), 40);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d shoulder(-25, -45 + shrug_mm, 185 * side);
    d = Blend(d, Capsule(p, {-25, -10, 60 * side}, shoulder, 45), 40);
    d = Blend(d, Capsule(p, shoulder, {-25, -330, 250 * side}, 42), 30);
    d = Blend(d, Capsule(p, {45, -28, 18 * side}, {10, -22 + shrug_mm / 2, 150 * side}, 9), 18);  // collar bone
  }
  return d;
}

std::optional<Vector3d> Trace(const std::function<double(const Vector3d&)>& distance_to, const Vector3d& ray,
                              double near_mm, double far_mm) {
  double along = near_mm;
  for (int i = 0; i < 120 && along < far_mm; ++i) {
    const double d = distance_to(along * ray);
    if (d < 0.02) return along * ray;
    along += 0.8 * d;  // the distances are first-order bounds
  }
  return std::nullopt;
}

/// A sensor of 430 x 340 pixels whose pixels are 2 mm apart at 2 m.
Surface See(const std::function<double(const Vector3d&)>& distance_to, double noise_mm, std::uint32_t seed,
            double distance_mm) {
  constexpr int kWidth = 430, kHeight = 340;
  constexpr double kFocal = 1000;
  Surface s;
  s.sensor_width_px = kWidth;
  s.sensor_height_px = kHeight;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const Vector3d ray((col - kWidth / 2.0) / kFocal, (row - kHeight / 2.0) / kFocal, 1);
      const auto hit = Trace(distance_to, ray.normalized(), distance_mm - 450, distance_mm + 250);
      if (!hit) continue;
      s.point_in_camera.push_back((*hit + ray * noise_mm * normal(random)).cast<float>());
      s.col.push_back(static_cast<std::uint16_t>(col));
      s.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return s;
}

}  // namespace

Eigen::Matrix3d CameraFromSubject() {
  Eigen::Matrix3d m;
  m << 0, 0, -1, 0, -1, 0, -1, 0, 0;
  return m;
}

double DistanceTo(const Bust& bust, const Vector3d& point) {
  const Vector3d p = bust.torso_motion.inverse() * point;
  double d = Torso(p, bust.breath_mm, bust.shrug_mm);
  if (!bust.with_head) return d;
  const Vector3d pivot(-15, 35, 0);
  const Vector3d in_head = bust.head_rotation.transpose() * (p - pivot);
  const Vector3d skull_base = pivot + bust.head_rotation * Vector3d(0, 60, 0);
  d = Blend(d, Capsule(p, {-20, -30, 0}, pivot, 52), 25);
  d = Blend(d, Capsule(p, pivot, skull_base, 52), 15);
  if (bust.ball_for_head) return Blend(d, (in_head - Vector3d(0, 120, 0)).norm() - 88, 10);
  return Blend(d, Head(in_head, bust.jaw_drop_mm), 10);
}

Surface SeenFromTheFront(const Bust& bust, double noise_mm, std::uint32_t seed, double distance_mm) {
  const Eigen::Matrix3d subject_from_camera = CameraFromSubject().transpose();
  // The base of the neck stands a little above the middle of the picture.
  const Vector3d origin_in_camera(10, -60, distance_mm);
  const auto distance_to = [&](const Vector3d& in_camera) {
    return DistanceTo(bust, subject_from_camera * (in_camera - origin_in_camera));
  };
  return See(distance_to, noise_mm, seed, distance_mm);
}

Surface SphereSeenFromTheFront(double radius_mm, double noise_mm, std::uint32_t seed) {
  return See([&](const Vector3d& p) { return (p - Vector3d(0, 0, 2000)).norm() - radius_mm; }, noise_mm, seed, 2000);
}

}  // namespace striae::testing
