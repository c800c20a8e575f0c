#include "acquire/rig/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "acquire/rig/detail/bands.h"
#include "acquire/rig/detail/exposure.h"
#include "acquire/rig/detail/shading.h"

namespace striae::rig {
namespace {

constexpr int kBand = 16;
constexpr double kFullSensorWidth = 4288;
constexpr int kMostMoments = 33;
constexpr double kEdgeSlope = 6;  // depth change over sideways distance that counts as an edge (80 degrees)

/// Rows first - 1 .. last, columns -1 .. width of samples at pixel centres.
class SampleBand {
 public:
  SampleBand(const detail::Shader& shader, int width, int first, int last)
      : samples_(width + 2, last - first + 2), first_(first) {
    for (int row = first - 1; row <= last; ++row) {
      for (int col = -1; col <= width; ++col) At(col, row) = shader.Trace({col, row});
    }
  }
  detail::Sample& At(int col, int row) { return samples_(col + 1, row - first_ + 1); }
  [[nodiscard]] const detail::Sample& At(int col, int row) const { return samples_(col + 1, row - first_ + 1); }

  /// One of the four neighbours meets something else: nothing, shadow, or a surface at another depth.
  [[nodiscard]] bool IsEdge(int col, int row, double pixel_rad) const {
    const detail::Sample& here = At(col, row);
    for (const auto* other : {&At(col - 1, row), &At(col + 1, row), &At(col, row - 1), &At(col, row + 1)}) {
      if (other->hit != here.hit || other->sees_light != here.sees_light) return true;
      if (here.hit && std::abs(other->depth_mm - here.depth_mm) > kEdgeSlope * pixel_rad * here.depth_mm) return true;
    }
    return false;
  }

 private:
  Image<detail::Sample> samples_;
  int first_;
};

Status Check(const TriangleMesh& mesh, const Calibration& calibration, const RenderOptions& options) {
  if (mesh.triangle.empty()) return Fail(ErrorCode::kUsage, "the virtual rig has no body to photograph");
  if (mesh.normal.size() != mesh.vertex.size() || mesh.albedo.size() != mesh.vertex.size()) {
    return Fail(ErrorCode::kUsage, "every vertex of the body needs a normal and an albedo");
  }
  const SensorOptions& s = options.sensor;
  const LightOptions& l = options.light;
  const bool sane = s.lens_blur_px >= 0 && s.lens_blur_px < 50 && s.iso > 0 && s.full_well_electrons > 0 &&
                    s.read_noise_electrons >= 0 && l.flash >= 0 && l.ambient >= 0 && l.leak >= 0 && l.leak <= 1 &&
                    l.blur_stripes >= 0 && l.blur_stripes < 0.25 && l.aperture_mm >= 0 && l.focus_mm > 0 &&
                    s.aperture_mm >= 0 && s.focus_mm > 0 && l.reference_mm > 0 && options.motion_mm.allFinite() &&
                    std::isfinite(s.iso + l.flash + l.ambient + l.aperture_mm + s.aperture_mm);
  if (!sane || options.threads < 1 || options.threads > 256) {
    return Fail(ErrorCode::kUsage,
                "light or sensor options cannot be meant: ISO, full well, distances of focus and threads are positive, "
                "light and apertures are not negative, blur is below 0.25 stripes and 50 px");
  }
  if (calibration.image_width_px < 1 || calibration.image_height_px < 1) {
    return Fail(ErrorCode::kUsage, "the rig's image size must be positive");
  }
  return {};
}

/// The body at evenly spaced moments of the exposure, about half a pixel apart; their number is odd, so that the middle
/// one is the body as given.
std::vector<detail::Shader> Moments(const detail::Shader& still, const CameraModel& camera,
                                    const RenderOptions& options) {
  const double motion_px = options.motion_mm.norm() * std::max(camera.fx, camera.fy) / options.light.reference_mm;
  const int count = motion_px > 0 ? std::min(2 * static_cast<int>(std::ceil(motion_px)) + 1, kMostMoments) : 1;
  std::vector<detail::Shader> moments;
  for (int i = 0; i < count; ++i) moments.push_back(still.Shifted(((i + 0.5) / count - 0.5) * options.motion_mm));
  return moments;
}

void AddLight(const detail::Shader& shader, const SampleBand& band, int first, int last, float share,
              const CameraModel& camera, Image<detail::LinearRgb>& light) {
  const double pixel_rad = 1 / std::min(camera.fx, camera.fy);
  for (int row = first; row < last; ++row) {
    for (int col = 0; col < light.width(); ++col) {
      const detail::Sample& sample = band.At(col, row);
      Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
      if (band.IsEdge(col, row, pixel_rad)) {
        rgb = shader.Edge({col, row});
      } else if (sample.hit) {
        Eigen::Vector3d across = band.At(col, row + 1).ray - sample.ray, along = band.At(col + 1, row).ray - sample.ray;
        if (!shader.AlongRows()) std::swap(across, along);
        rgb = shader.Smooth(sample, across, along);
      }
      for (std::size_t c = 0; c < 3; ++c) light(col, row)[c] += share * rgb[static_cast<Eigen::Index>(c)];
    }
  }
}

void KeepTruth(const detail::Shader& shader, const SampleBand& band, int first, int last, Rendering& result) {
  for (int row = first; row < last; ++row) {
    for (int col = 0; col < result.lit.width(); ++col) {
      const detail::Sample& sample = band.At(col, row);
      if (!sample.hit) continue;
      result.depth_mm(col, row) = static_cast<float>(sample.depth_mm);
      const auto order = shader.LitOrder(sample);
      if (!order) continue;
      result.order(col, row) = static_cast<float>(*order);
      result.lit(col, row) = 1;
    }
  }
}

}  // namespace

Result<Rendering> Render(const TriangleMesh& mesh, const Calibration& calibration, const RenderOptions& options) {
  if (auto ok = Check(mesh, calibration, options); !ok) return Fail(ok.error());
  auto scene = detail::RayScene::Build(mesh);
  if (!scene) return Fail(scene.error());
  const detail::Shader still(mesh, *scene, calibration, options.light);
  const std::vector<detail::Shader> moments = Moments(still, calibration.camera, options);
  const int width = calibration.image_width_px, height = calibration.image_height_px;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Rendering result{{}, ImageF(width, height, kNan), ImageF(width, height, kNan), Mask(width, height)};
  Image<detail::LinearRgb> light(width, height, detail::LinearRgb{});
  const float share = 1 / static_cast<float>(moments.size());
  detail::ForEachBand(height, kBand, options.threads, [&](int first, int last) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const SampleBand band(moments[i], width, first, last);
      AddLight(moments[i], band, first, last, share, calibration.camera, light);
      if (i == moments.size() / 2) KeepTruth(moments[i], band, first, last, result);
    }
  });
  const double scale = width / kFullSensorWidth;
  const detail::LensBlur blur{options.sensor.lens_blur_px * scale, options.sensor.aperture_mm * calibration.camera.fx,
                              options.sensor.focus_mm};
  result.photograph =
      detail::Expose(light, result.depth_mm, options.sensor, blur, 1 / (scale * scale), options.threads);
  return result;
}

}  // namespace striae::rig
