#include "tests/reconstruct/scenes_render.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "core/optics.h"

namespace striae::testing {
namespace {

using Eigen::Vector3d;

struct Hit {
  double along = std::numeric_limits<double>::infinity();
  const Body* body = nullptr;
  Vector3d in_unit = Vector3d::Zero(), normal = Vector3d::Zero();  ///< normal in the camera frame, unit
};

/// A body with its inverse map, as rays want it.
struct Solid {
  const Body* body;
  Eigen::Affine3d unit_from_camera;
};

/// Where the ray first meets the unit shape beyond `least`, or infinity.
double Meet(Body::Kind kind, const Vector3d& from, const Vector3d& way, double least) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (kind == Body::Kind::kSquare) {
    const double t = -from.z() / way.z();
    const Vector3d at = from + t * way;
    return t > least && std::abs(at.x()) < 1 && std::abs(at.y()) < 1 ? t : kNever;
  }
  Vector3d o = from, d = way;
  if (kind == Body::Kind::kTube) o.y() = d.y() = 0;
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1, root = b * b - a * c;
  if (root < 0 || a == 0) return kNever;
  for (const double t : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a}) {
    if (t > least && (kind == Body::Kind::kBall || std::abs(from.y() + t * way.y()) < 1)) return t;
  }
  return kNever;
}

class World {
 public:
  explicit World(const BodyScene& scene)
      : scene_(scene),
        optics_(scene.rig),
        projector_(scene.rig.projector.center_mm),
        middle_mm_((scene.rig.near_mm + scene.rig.far_mm) / 2) {
    for (const Body& body : scene.bodies) solids_.push_back({&body, body.camera_from_unit.inverse()});
  }

  [[nodiscard]] Hit First(const Vector3d& ray) const {
    Hit hit;
    for (const Solid& solid : solids_) {
      const Vector3d from = solid.unit_from_camera.translation(), way = solid.unit_from_camera.linear() * ray;
      const double t = Meet(solid.body->kind, from, way, 1.0);
      if (t >= hit.along) continue;
      Vector3d normal = from + t * way;
      if (solid.body->kind == Body::Kind::kTube) normal.y() = 0;
      if (solid.body->kind == Body::Kind::kSquare) normal = Vector3d::UnitZ();
      normal = (solid.unit_from_camera.linear().transpose() * normal).normalized();
      hit = {t, solid.body, from + t * way, normal.dot(ray) > 0 ? Vector3d(-normal) : normal};
    }
    return hit;
  }

  /// Linear light of one ray (z = 1).
  [[nodiscard]] double Light(const Vector3d& ray) const {
    const Hit hit = First(ray);
    if (hit.body == nullptr) return 0;
    const Vector3d point = hit.along * ray, to_light = projector_ - point;
    const double facing = hit.normal.dot(to_light) / to_light.norm();
    double light = scene_.ambient;
    if (facing > 0 && Sees(point, to_light)) {
      const auto order = optics_.OrderAt(point);
      const double fall_off = middle_mm_ * middle_mm_ / to_light.squaredNorm();
      if (order) light += scene_.flash * fall_off * facing * Passed(*order);
    }
    return hit.body->albedo(hit.in_unit) * light;
  }

 private:
  /// Chromium outside of the field lets nothing through; between the stripes it leaks.
  [[nodiscard]] double Passed(double order) const {
    const double stripes = scene_.rig.stripes.value_or(1000);
    if (order < -0.6 || order > stripes - 0.4) return 0;
    const double from_center = std::abs(order - std::clamp(std::round(order), 0.0, stripes - 1));
    return scene_.leak + (1 - scene_.leak) * 0.5 * std::erfc((from_center - 0.25) / scene_.softness);
  }
  [[nodiscard]] bool Sees(const Vector3d& point, const Vector3d& to_light) const {
    constexpr double kOff = 1e-4;  // share of the way: the surface does not shade itself
    return std::none_of(solids_.begin(), solids_.end(), [&](const Solid& solid) {
      return Meet(solid.body->kind, solid.unit_from_camera * point, solid.unit_from_camera.linear() * to_light, kOff) <
             1;
    });
  }

  const BodyScene& scene_;
  StripeOptics optics_;
  Vector3d projector_;
  double middle_mm_;
  std::vector<Solid> solids_;
};

double SrgbEncoded(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// Calls row(y) for every row, two rows at a time.
template <typename Row>
void EachRow(int height, const Row& row) {
  std::thread odd([&] {
    for (int y = 1; y < height; y += 2) row(y);
  });
  for (int y = 0; y < height; y += 2) row(y);
  odd.join();
}

}  // namespace

Body Placed(Body::Kind kind, const Vector3d& center, const Vector3d& half_axes, const Eigen::Matrix3d& turned) {
  Body body;
  body.kind = kind;
  body.camera_from_unit.linear() = turned * half_axes.asDiagonal();
  body.camera_from_unit.translation() = center;
  return body;
}

Photograph PhotographOf(const BodyScene& scene) {
  const World world(scene);
  const int width = scene.rig.image_width_px, height = scene.rig.image_height_px;
  Photograph photograph{ImageF(width, height), ImageRgb(width, height), 1.0F};
  const bool along_rows = scene.rig.direction == StripeDirection::kHorizontal;
  EachRow(height, [&](int row) {
    std::mt19937 engine(scene.seed * 100003U + static_cast<std::uint32_t>(row));
    std::normal_distribution<double> noise(0, scene.noise);
    for (int col = 0; col < width; ++col) {
      double light = 0;
      // Four samples over the pixel, spread across the stripes.
      constexpr std::array<double, 4> kAcross = {-0.375, -0.125, 0.125, 0.375}, kAlong = {0.1, -0.3, 0.3, -0.1};
      for (std::size_t i = 0; i < kAcross.size(); ++i) {
        const double x = col + (along_rows ? kAlong[i] : kAcross[i]), y = row + (along_rows ? kAcross[i] : kAlong[i]);
        light += world.Light(RayOf(scene.rig.camera, {x, y})) / 4;
      }
      light += noise(engine) * std::sqrt((light + 0.005) / 0.1);
      const auto byte = static_cast<std::uint8_t>(std::lround(255 * SrgbEncoded(light)));
      photograph.luminance(col, row) = static_cast<float>(byte) / 255;
      photograph.colour(col, row) = {byte, byte, byte};
    }
  });
  return photograph;
}

ImageF DepthOf(const BodyScene& scene) {
  const World world(scene);
  ImageF depth(scene.rig.image_width_px, scene.rig.image_height_px, std::numeric_limits<float>::quiet_NaN());
  EachRow(depth.height(), [&](int row) {
    for (int col = 0; col < depth.width(); ++col) {
      const Hit hit = world.First(RayOf(scene.rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (hit.body != nullptr) depth(col, row) = static_cast<float>(hit.along);
    }
  });
  return depth;
}

}  // namespace striae::testing
