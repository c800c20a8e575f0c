#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include "analysis/head/detail/registration.h"
#include "analysis/head/detail/weights.h"

namespace striae::head::detail {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

constexpr std::size_t kLeastPairs = 50;
constexpr double kHiddenCost = 0.25;
constexpr float kFieldRimMm = 6;
constexpr double kJudgedNormalsDeg = 35;

PclCloud::Ptr ToPcl(const Points& points) {
  PclCloud::Ptr out(new PclCloud);
  out->reserve(points.size());
  for (const auto& p : points) out->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  return out;
}

/// How far a step moves points within 100 mm of the patch's middle, mm.
double Reach(const Eigen::Isometry3d& step, const Eigen::Vector3d& middle) {
  return (step * middle - middle).norm() + 100 * Eigen::AngleAxisd(step.linear()).angle();
}

/// What a capture shows: the box around its rays' slopes, less a rim where the Fourier window frays.
struct Field {
  Eigen::Array2f least = Eigen::Array2f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array2f most = -least;

  void Include(const Eigen::Vector3f& p) {
    const Eigen::Array2f slope = p.head<2>().array() / p.z();
    least = least.min(slope);
    most = most.max(slope);
  }
  [[nodiscard]] bool Shows(const Eigen::Vector3f& p) const {
    const Eigen::Array2f slope = p.head<2>().array() / p.z();
    const float rim = kFieldRimMm / p.z();
    return (slope >= least + rim).all() && (slope <= most - rim).all();
  }
};

/// Pairs with what weighing them needs.
struct Matches {
  std::vector<Pair> pairs;
  std::vector<double> sd_mm;
  std::vector<std::size_t> of;  ///< the patch's point of each pair
};

}  // namespace

Result<Cloud> WithNormals(const Thinned& points, double radius_mm) try {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const PclCloud::Ptr input = ToPcl(points.point);
  const Tree::Ptr tree(new Tree(false));
  tree->setInputCloud(input);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(input);
  estimation.setSearchMethod(tree);
  estimation.setViewPoint(0, 0, 0);
  Cloud cloud;
  pcl::Indices neighbours;
  std::vector<float> squared;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (tree->radiusSearch(static_cast<int>(i), radius_mm, neighbours, squared) < 6) continue;
    float nx = 0, ny = 0, nz = 0, curvature = 0;
    if (!estimation.computePointNormal(*input, neighbours, nx, ny, nz, curvature)) continue;
    Eigen::Vector3f normal(nx, ny, nz);
    if (!normal.allFinite()) continue;
    if (normal.dot(points.point[i]) > 0) normal = -normal;
    cloud.point.push_back(points.point[i]);
    cloud.normal.push_back(normal.normalized());
    cloud.sd_mm.push_back(points.sd_mm[i]);
    cloud.pixel.push_back(points.pixel[i]);
  }
  return cloud;
} catch (const std::exception& e) {
  return Fail(ErrorCode::kInternal, std::string("normals of the surface could not be computed: ") + e.what());
}

struct Target::Impl {
  Cloud cloud;
  Field field;
  Tree::Ptr tree;

  /// The nearest counterpart of every point of the patch, within the gates.
  [[nodiscard]] Matches Match(const Cloud& patch, const Eigen::Isometry3d& motion, const Stage& gate) const {
    Matches matches;
    const Eigen::Matrix3f turn = motion.linear().cast<float>();
    const auto alike = static_cast<float>(std::cos(gate.normals_deg * std::numbers::pi / 180));
    pcl::Indices nearest(1);
    std::vector<float> squared(1);
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const Eigen::Vector3d moved = motion * patch.point[i].cast<double>();
      const pcl::PointXYZ query(static_cast<float>(moved.x()), static_cast<float>(moved.y()),
                                static_cast<float>(moved.z()));
      // The nearest one, within the gate only: without an end the search for a far point visits most of the tree.
      if (tree->radiusSearch(query, gate.distance_mm, nearest, squared, 1) < 1) continue;
      const auto k = static_cast<std::size_t>(nearest[0]);
      const Eigen::Vector3f normal = turn * patch.normal[i];
      if (normal.dot(cloud.normal[k]) < alike) continue;
      const Eigen::Vector3d between = (normal + cloud.normal[k]).normalized().cast<double>();
      matches.pairs.push_back({moved, cloud.point[k].cast<double>(), between});
      matches.sd_mm.push_back(std::hypot(patch.sd_mm[i], cloud.sd_mm[k]));
      matches.of.push_back(i);
    }
    return matches;
  }
};

Target::Target(Cloud cloud) : impl_(std::make_unique<Impl>()) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  for (const auto& p : cloud.point) impl_->field.Include(p);
  impl_->tree.reset(new Tree(false));
  impl_->tree->setInputCloud(ToPcl(cloud.point));
  impl_->cloud = std::move(cloud);
}
Target::~Target() = default;
Target::Target(Target&&) noexcept = default;
Target& Target::operator=(Target&&) noexcept = default;

Eigen::Isometry3d Target::Align(const Cloud& patch, const Eigen::Isometry3d& start,
                                std::span<const Stage> stages) const {
  Eigen::Isometry3d motion = start;
  for (const Stage& stage : stages) {
    for (int i = 0; i < stage.iterations; ++i) {
      Matches matches = impl_->Match(patch, motion, stage);
      if (matches.pairs.size() < kLeastPairs) return motion;
      if (stage.robust) {
        WeighRobustly(matches.pairs, matches.sd_mm);
      } else {
        WeighTrimmed(matches.pairs);
      }
      const Eigen::Isometry3d step = SolveStep(matches.pairs);
      motion = step * motion;
      if (Reach(step, matches.pairs[matches.pairs.size() / 2].moved) < 0.01) break;
    }
  }
  return motion;
}

Fit Target::Judge(const Cloud& patch, const Eigen::Isometry3d& target_from_patch, double distance_mm) const {
  Fit fit;
  fit.target_from_patch = target_from_patch;
  Matches matched = impl_->Match(patch, target_from_patch, {distance_mm, kJudgedNormalsDeg, 1});
  // A point whose skin is turned more than 75 degrees from the camera, or that has left the lit field, cannot have a
  // counterpart.
  std::vector<char> visible(patch.size());
  std::size_t visible_count = 0, found = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const Eigen::Vector3f point = (target_from_patch * patch.point[i].cast<double>()).cast<float>();
    const Eigen::Vector3f normal = target_from_patch.linear().cast<float>() * patch.normal[i];
    const bool faces = -point.normalized().dot(normal) > 0.26F;
    visible[i] = faces && impl_->field.Shows(point) ? 1 : 0;
    visible_count += static_cast<std::size_t>(visible[i]);
  }
  // Without a counterpart a hidden point costs a little, so that hiding the patch is no way to fit it.
  const auto cost = [&](std::size_t i) { return visible[i] != 0 ? 1.0 : kHiddenCost; };
  double loss = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) loss += cost(i);
  std::vector<double> squares;
  for (std::size_t k = 0; k < matched.pairs.size(); ++k) {
    const std::size_t i = matched.of[k];
    const Pair& pair = matched.pairs[k];
    loss += (pair.moved - pair.target).squaredNorm() / (distance_mm * distance_mm) - cost(i);
    found += static_cast<std::size_t>(visible[i]);
    squares.push_back(pair.ToPlane() * pair.ToPlane());
  }
  if (patch.size() == 0 || visible_count == 0 || matched.pairs.empty()) return fit;
  fit.loss = loss / static_cast<double>(patch.size());
  fit.visible = static_cast<double>(visible_count) / static_cast<double>(patch.size());
  fit.overlap = static_cast<double>(found) / static_cast<double>(visible_count);
  std::vector<double> sds = matched.sd_mm;
  std::nth_element(sds.begin(), sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2), sds.end());
  fit.noise_mm = sds[sds.size() / 2];
  fit.agreement = WeighRobustly(matched.pairs, matched.sd_mm);
  std::sort(squares.begin(), squares.end());
  squares.resize(std::max<std::size_t>(1, squares.size() * 9 / 10));
  double sum = 0;
  for (const double square : squares) sum += square;
  fit.residual_mm = std::sqrt(sum / static_cast<double>(squares.size()));
  fit.pairs = std::move(matched.pairs);
  return fit;
}

}  // namespace striae::head::detail
