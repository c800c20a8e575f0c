#include "acquire/rig/detail/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "acquire/rig/detail/paint.h"

namespace striae::rig::detail {
namespace {

constexpr double kLift_mm = 0.02;  // shadow rays start above the facet, beyond float precision at 2 m
constexpr double kNeedle_mm = 0.5;
constexpr std::array kAcross = {-0.375, -0.125, 0.125, 0.375};  // places across the stripes within a pixel
constexpr std::array kAlong = {-0.333, 0.0, 0.333};

}  // namespace

Shader::Shader(const TriangleMesh& mesh, const RayScene& scene, const Calibration& calibration,
               const LightOptions& options)
    : mesh_(mesh),
      scene_(scene),
      calibration_(calibration),
      optics_(calibration),
      stripes_(StripesOf(calibration)),
      options_(options),
      grating_(std::make_shared<const GratingLight>(stripes_)),
      projector_(calibration, stripes_, options) {}

Shader Shader::Shifted(const Eigen::Vector3d& shift_mm) const {
  Shader shifted = *this;
  shifted.shift_mm_ = shift_mm;
  return shifted;
}

Shader::Plane Shader::PlaneOf(std::uint32_t triangle) const {
  const auto& t = mesh_.triangle[triangle];
  const Eigen::Vector3d& a = mesh_.vertex[t[0]];
  const Eigen::Vector3d normal = (mesh_.vertex[t[1]] - a).cross(mesh_.vertex[t[2]] - a);
  return {normal, normal.dot(a + shift_mm_)};
}

Sample Shader::Trace(const Eigen::Vector2d& pixel) const {
  Sample sample;
  sample.ray = RayOf(calibration_.camera, pixel);
  const auto hit = scene_.First(-shift_mm_, sample.ray);
  if (!hit) return sample;
  sample.hit = true;
  sample.where = *hit;
  const Plane plane = PlaneOf(hit->triangle);
  // Embree works in single precision; the facet's plane gives the depth in double, but for needles seen edge-on.
  sample.depth_mm = plane.offset / plane.normal.dot(sample.ray);
  if (!(std::abs(sample.depth_mm - hit->place) < kNeedle_mm)) sample.depth_mm = hit->place;
  const Eigen::Vector3d point = sample.depth_mm * sample.ray - shift_mm_;
  const Eigen::Vector3d light = calibration_.projector.center_mm - shift_mm_;
  const Eigen::Vector3d out = plane.normal.dot(sample.ray) < 0 ? plane.normal : Eigen::Vector3d(-plane.normal);
  if (out.dot(light - point) > 0) sample.sees_light = scene_.Sees(point + kLift_mm * out.normalized(), light);
  return sample;
}

std::optional<double> Shader::LitOrder(const Sample& sample) const {
  if (!sample.hit || !sample.sees_light) return std::nullopt;
  const Eigen::Vector3d point = sample.depth_mm * sample.ray;
  const auto order = optics_.OrderAt(point);
  if (!order || *order < -0.25 || *order > stripes_ - 0.75) return std::nullopt;
  const double centre_mm = (point - calibration_.projector.center_mm).norm();
  const double unmasked = options_.flash * std::pow(options_.reference_mm / centre_mm, 2);
  if (projector_.At(point) <= 0.25 * unmasked) return std::nullopt;  // half of it at the mask's edge, less vignetting
  return order;
}

Eigen::Vector3f Shader::Painted(const Sample& centre, const Plane& plane, const Eigen::Vector3d& across,
                                const Eigen::Vector3d& along, double direct, double blur,
                                const Eigen::Vector3f& skin) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const double i : kAcross) {
    for (const double j : kAlong) {
      const Eigen::Vector3d ray = centre.ray + i * across + j * along;
      const Eigen::Vector3d point = plane.offset / plane.normal.dot(ray) * ray;
      const double passed = direct > 0 ? grating_->At(optics_.OrderAt(point).value_or(-10), blur) : 0;
      const auto light = static_cast<float>(direct * (options_.leak + (1 - options_.leak) * passed) + options_.ambient);
      const auto paint = PaintAt(mesh_, point - shift_mm_);
      sum += light * (paint ? Eigen::Vector3f(Eigen::Vector3f::Constant(*paint)) : skin);
    }
  }
  return sum / static_cast<float>(kAcross.size() * kAlong.size());
}

Eigen::Vector3f Shader::Smooth(const Sample& centre, const Eigen::Vector3d& across,
                               const Eigen::Vector3d& along) const {
  const auto& t = mesh_.triangle[centre.where.triangle];
  const double u = centre.where.u, v = centre.where.v, w = 1 - u - v;
  const Eigen::Vector3f skin = SkinAlbedo(mesh_, centre.where);
  const double cos_field = 1 / centre.ray.norm();
  const double lens = std::pow(cos_field, 4);
  const Eigen::Vector3d point = centre.depth_mm * centre.ray;
  const Plane plane = PlaneOf(centre.where.triangle);
  double direct = 0, blur = 0;  // light that faces the surface, before the grating
  if (centre.sees_light) {
    Eigen::Vector3d normal = (w * mesh_.normal[t[0]] + u * mesh_.normal[t[1]] + v * mesh_.normal[t[2]]).normalized();
    if (normal.dot(centre.ray) > 0) normal = -normal;
    blur = projector_.BlurAt(point);
    direct = projector_.At(point) * std::max(0.0, normal.dot((calibration_.projector.center_mm - point).normalized()));
  }
  if (!mesh_.decal.empty() && NearPaint(mesh_, point - shift_mm_, 2 * centre.depth_mm * across.norm())) {
    return static_cast<float>(lens) * Painted(centre, plane, across, along, direct, blur, skin);
  }
  double passed = 0;
  if (direct > 0) {
    for (const double offset : kAcross) {
      const Eigen::Vector3d ray = centre.ray + offset * across;
      const auto order = optics_.OrderAt(plane.offset / plane.normal.dot(ray) * ray);
      if (order) passed += grating_->At(*order, blur) / kAcross.size();
    }
  }
  const double light = direct * (options_.leak + (1 - options_.leak) * passed);
  return static_cast<float>((light + options_.ambient) * lens) * skin;
}

Eigen::Vector3f Shader::Edge(const Eigen::Vector2d& pixel) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const double across : kAcross) {
    for (const double along : kAlong) {
      const Eigen::Vector2d offset = AlongRows() ? Eigen::Vector2d(along, across) : Eigen::Vector2d(across, along);
      const Sample sample = Trace(pixel + offset);
      if (sample.hit) sum += Smooth(sample, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    }
  }
  return sum / static_cast<float>(kAcross.size() * kAlong.size());
}

}  // namespace striae::rig::detail
