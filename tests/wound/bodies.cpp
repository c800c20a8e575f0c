#include "tests/wound/bodies.h"

#include <cmath>
#include <optional>
#include <random>

#include <Eigen/Geometry>

namespace striae::testing {
namespace {

constexpr double kFarFromAxis = 1e9;

// Body frame: axis along y through the origin's depth, front towards -z. A plate: z = 0, s = x.
struct Pose {
  Eigen::Matrix3d camera_from_body;
  Eigen::Vector3d origin_in_camera;
};

Pose PoseOf(const Body& body) {
  // The crater's middle on the uncarved skin is put on the optical axis.
  const double r = body.radius_mm;
  const Eigen::Vector3d middle(r * std::sin(body.turn_rad), 0, -r * std::cos(body.turn_rad));
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(body.tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return {rotation, Eigen::Vector3d(0, 0, body.distance_mm) - rotation * middle};
}

// Positive outside the carved body.
double Outside(const Body& body, const Eigen::Vector3d& p) {
  if (body.radius_mm == 0) return -p.z() + body.Depth(p.x(), p.y());
  const double angle = std::atan2(p.x(), -p.z()) - body.turn_rad;
  return std::hypot(p.x(), p.z()) - (body.RadiusAt(p.y()) - body.Depth(angle * body.radius_mm, p.y()));
}

std::optional<double> Hit(const Body& body, const Pose& pose, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d eye = -pose.camera_from_body.transpose() * pose.origin_in_camera;
  const Eigen::Vector3d direction = pose.camera_from_body.transpose() * ray;
  const auto outside = [&](double t) { return Outside(body, eye + t * direction); };
  // Outside() is at most the true distance times the slope of the dent (below 1.5): half of it never steps through.
  const double end = body.distance_mm + 2 * body.radius_mm + 100;
  double t = body.distance_mm - 80;
  for (double gap = outside(t); t < end; gap = outside(t)) {
    if (gap <= 0) {
      double low = t - 0.02, high = t;
      for (int k = 0; k < 20; ++k) {
        const double middle = (low + high) / 2;
        (outside(middle) > 0 ? low : high) = middle;
      }
      return high;
    }
    t += std::max(0.5 * gap, 0.02);
  }
  return std::nullopt;
}

Image<double> SmoothNoise(int width, int height, double length_px, std::mt19937& random) {
  // White noise on a coarse grid, joined by cosines: unit variance at the nodes.
  const int cols = static_cast<int>(width / length_px) + 2, rows = static_cast<int>(height / length_px) + 2;
  std::normal_distribution<double> normal;
  Image<double> nodes(cols, rows), out(width, height);
  for (double& n : nodes.pixels()) n = normal(random);
  const auto ease = [](double t) { return (1 - std::cos(M_PI * t)) / 2; };
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const double x = col / length_px, y = row / length_px;
      const int i = static_cast<int>(x), j = static_cast<int>(y);
      const double u = ease(x - i), v = ease(y - j);
      out(col, row) = (1 - u) * (1 - v) * nodes(i, j) + u * (1 - v) * nodes(i + 1, j) + (1 - u) * v * nodes(i, j + 1) +
                      u * v * nodes(i + 1, j + 1);
    }
  }
  return out;
}

}  // namespace

double Body::RadiusAt(double y_mm) const {
  if (radius_mm == 0) return kFarFromAxis;
  return radius_mm + taper * y_mm + bulge_per_mm * y_mm * y_mm;
}

double Body::Depth(double s_mm, double y_mm) const {
  const double rho = std::hypot(s_mm, y_mm), a = crater_radius_mm;
  if (rho < a) return crater_depth_mm * (1 - rho * rho / (a * a)) - rim_mm * rho * rho / (a * a);
  return -rim_mm * std::exp(-(rho - a) / rim_decay_mm);
}

double Body::CraterVolumeMm3() const {
  const double a = crater_radius_mm, d = crater_depth_mm;
  if (radius_mm == 0) return M_PI * a * a * d / 2;
  if (taper == 0 && bulge_per_mm == 0) return M_PI * a * a * (d / 2 - d * d / (6 * radius_mm));
  return NetVolumeMm3(a);
}

double Body::NetVolumeMm3(double rho_mm) const {
  double volume = 0;
  const double step = rho_mm / 500;
  for (double y = -rho_mm + step / 2; y < rho_mm; y += step) {
    for (double s = -rho_mm + step / 2; s < rho_mm; s += step) {
      if (std::hypot(s, y) >= rho_mm) continue;
      const double depth = Depth(s, y);
      volume += (radius_mm == 0 ? depth : (RadiusAt(y) * depth - depth * depth / 2) / radius_mm) * step * step;
    }
  }
  return volume;
}

Surface Observe(const Body& body, const Camera& camera, const Noise& noise) {
  const Pose pose = PoseOf(body);
  std::mt19937 random(noise.seed);
  std::normal_distribution<double> normal;
  const Image<double> smooth = SmoothNoise(camera.width, camera.height, noise.length_px, random);
  Surface surface;
  surface.sensor_width_px = camera.width;
  surface.sensor_height_px = camera.height;
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col) {
      const Eigen::Vector3d ray = Eigen::Vector3d((col - (camera.width - 1) / 2.0) / camera.focal_px,
                                                  (row - (camera.height - 1) / 2.0) / camera.focal_px, 1);
      const auto hit = Hit(body, pose, ray);
      if (!hit) continue;
      const double t = *hit + noise.white_mm * normal(random) + noise.correlated_mm * smooth(col, row);
      surface.point_in_camera.push_back((t * ray).cast<float>());
      surface.colour.push_back({200, 160, 150});
      surface.quality.push_back(1);
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return surface;
}

Outline CircleOn(const Body& body, const Camera& camera, double radius_mm, int points) {
  const Pose pose = PoseOf(body);
  Outline outline;
  for (int k = 0; k < points; ++k) {
    const double s = radius_mm * std::cos(2 * M_PI * k / points), y = radius_mm * std::sin(2 * M_PI * k / points);
    Eigen::Vector3d p(s, y, 0);
    if (body.radius_mm > 0) {
      const double angle = s / body.radius_mm + body.turn_rad;
      p = {body.RadiusAt(y) * std::sin(angle), y, -body.RadiusAt(y) * std::cos(angle)};
    }
    const Eigen::Vector3d in_camera = pose.camera_from_body * p + pose.origin_in_camera;
    outline.polygon_px.emplace_back(camera.focal_px * in_camera.x() / in_camera.z() + (camera.width - 1) / 2.0,
                                    camera.focal_px * in_camera.y() / in_camera.z() + (camera.height - 1) / 2.0);
  }
  return outline;
}

Surface Keep(const Surface& surface, const std::function<bool(int, int)>& keep) {
  Surface kept;
  kept.sensor_width_px = surface.sensor_width_px;
  kept.sensor_height_px = surface.sensor_height_px;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!keep(surface.col[i], surface.row[i])) continue;
    kept.point_in_camera.push_back(surface.point_in_camera[i]);
    kept.colour.push_back(surface.colour[i]);
    kept.quality.push_back(surface.quality[i]);
    kept.col.push_back(surface.col[i]);
    kept.row.push_back(surface.row[i]);
  }
  return kept;
}

}  // namespace striae::testing
