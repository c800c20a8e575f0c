// From a label's size to the whole number of the region that it lies on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "reconstruct/detail/order_evidence.h"
#include "reconstruct/detail/order_lines.h"
#include "reconstruct/detail/target_pose.h"

namespace striae::reconstruct::detail {
namespace {

constexpr std::size_t kFewest = 60;  ///< samples on the label

/// Twice the signed area of a, b, p: its sign says on which side of the line p lies.
double Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// The region's pixels on the label.
std::vector<RegionSample> SamplesOnLabel(const OrderScene& scene, int region, const TargetSighting& target) {
  // The paper stands out by a sixth of the side; half of that is surely flat.
  constexpr double kPaper = 1.15;
  std::array<Eigen::Vector2d, 4> corner = target.corner_px;
  const Eigen::Vector2d middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
  Eigen::Vector2d least = middle, most = middle;
  for (Eigen::Vector2d& c : corner) {
    c = middle + kPaper * (c - middle);
    least = least.cwiseMin(c);
    most = most.cwiseMax(c);
  }
  const auto& phase = scene.phase;
  const int step = std::max(1, static_cast<int>((most - least).maxCoeff() / 120));
  std::vector<RegionSample> samples;
  for (int row = std::max(0, static_cast<int>(least.y())); row < std::min<double>(phase.mask.height(), most.y());
       row += step) {
    for (int col = std::max(0, static_cast<int>(least.x())); col < std::min<double>(phase.mask.width(), most.x());
         col += step) {
      if (phase.unwrapped.region(col, row) != region) continue;
      const Eigen::Vector2d pixel(col, row);
      bool inside = true;
      for (std::size_t k = 0; k < 4; ++k) inside = inside && Side(corner[k], corner[(k + 1) % 4], pixel) >= 0;
      if (!inside) continue;
      samples.push_back(
          {RayOf(scene.calibration.camera, pixel), phase.unwrapped.phase(col, row) / (2 * std::numbers::pi)});
    }
  }
  return samples;
}

/// Order that the plane predicts at the samples minus the measured one: the median.
double OffsetFromPlane(const OrderScene& scene, const std::vector<RegionSample>& samples, const Eigen::Vector3d& middle,
                       const Eigen::Vector3d& normal) {
  std::vector<double> offsets;
  for (const RegionSample& sample : samples) {
    const double depth = middle.dot(normal) / sample.ray.dot(normal);
    const auto order = depth > 0 ? scene.optics.OrderAt(depth * sample.ray) : std::nullopt;
    if (order) offsets.push_back(*order - sample.order);
  }
  return offsets.size() < kFewest ? std::numeric_limits<double>::quiet_NaN() : MedianOf(offsets);
}

/// Normal (towards the camera) of the plane through what the stripes measure there with this offset; print edges, where
/// the phase is bent, are left out as stragglers.
std::optional<Eigen::Vector3d> NormalFromStripes(const OrderScene& scene, const std::vector<RegionSample>& samples,
                                                 double offset) {
  std::vector<Eigen::Vector3d> points;
  for (const RegionSample& sample : samples) {
    if (const auto z = scene.optics.DepthAt(sample.ray, sample.order + offset)) points.push_back(*z * sample.ray);
  }
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  // z = a x + b y + c
  for (int round = 0; round < 5; ++round) {
    if (points.size() < kFewest) return std::nullopt;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d row(p.x(), p.y(), 1);
      normal += row * row.transpose();
      right += p.z() * row;
    }
    plane = normal.ldlt().solve(right);
    const auto miss = [&](const Eigen::Vector3d& p) {
      return std::abs(p.z() - plane.x() * p.x() - plane.y() * p.y() - plane.z());
    };
    std::vector<double> misses;
    for (const Eigen::Vector3d& p : points) misses.push_back(miss(p));
    const double most = 3 * MedianOf(misses) + 1e-6;
    std::erase_if(points, [&](const Eigen::Vector3d& p) { return miss(p) > most; });
  }
  const Eigen::Vector3d normal = Eigen::Vector3d(plane.x(), plane.y(), -1).normalized();
  return normal.allFinite() ? std::optional(normal) : std::nullopt;
}

}  // namespace

std::optional<RegionOrder> FromTarget(const OrderScene& scene, int region, const TargetSighting& target) {
  const auto samples = SamplesOnLabel(scene, region, target);
  double expected = OffsetFromPlane(scene, samples, target.middle_mm, target.normal);
  if (!std::isfinite(expected)) return std::nullopt;
  // The stripes know the label's tilt far better than its outline does, whichever the whole number.
  Eigen::Vector3d middle = target.middle_mm;
  double sd_mm = target.distance_sd_mm;
  for (int round = 0; round < 2; ++round) {
    const auto normal = NormalFromStripes(scene, samples, std::round(expected));
    const auto pose = normal ? PoseOf(target.sides, target.side_mm, normal) : std::nullopt;
    if (!pose) break;
    constexpr double kPrint = 0.001;  // a printer's scale
    middle = pose->middle;
    sd_mm = std::hypot(pose->depth_sd_mm, kPrint * middle.z());
    expected = OffsetFromPlane(scene, samples, middle, *normal);
    if (!std::isfinite(expected)) return std::nullopt;
  }
  const double sd = sd_mm / std::abs(scene.optics.DepthPerStripe(middle / middle.z(), middle.z()));
  RegionOrder found;
  found.source = OrderSource::kTarget;
  found.offset = static_cast<int>(std::lround(expected));
  const double remainder = std::abs(expected - found.offset);
  // The next whole number is 1 - remainder away: by so many standard uncertainties it is the worse one.
  constexpr double kSure = 4, kLikely = 3, kBend = 0.05;
  found.margin = std::clamp(1 - 2 * (remainder + sd), 0.0, 1.0);
  const double slack = RangeSlack(scene.calibration);
  if (middle.z() < scene.calibration.near_mm - slack || middle.z() > scene.calibration.far_mm + slack) {
    found.margin = 0;
    found.warning = "the label's size puts it at " + std::to_string(std::lround(middle.z())) +
                    " mm, outside of the working range; check the side length that was given for the label";
  } else if ((1 - remainder) < kSure * sd || remainder > kLikely * sd + kBend) {
    found.warning =
        "the label's size fits no whole stripe number well; check its side length, and that it lies flat and faces the "
        "camera";
  }
  return found;
}

}  // namespace striae::reconstruct::detail
