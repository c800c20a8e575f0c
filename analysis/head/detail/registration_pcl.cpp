#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/correspondence_rejection_trimmed.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>
#include <pcl/search/kdtree.h>

#include "analysis/head/detail/registration.h"

namespace striae::head::detail {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointNormal>;

constexpr float kTrim = 0.9F;
constexpr std::size_t kLeastPairs = 50;
constexpr double kHiddenCost = 0.25;
constexpr float kFieldRimMm = 6;
constexpr double kJudgedNormalsDeg = 35;

PclCloud::Ptr ToPcl(const Cloud& cloud, const Eigen::Isometry3d& motion) {
  PclCloud::Ptr out(new PclCloud);
  out->resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    (*out)[i].getVector3fMap() = (motion * cloud.point[i].cast<double>()).cast<float>();
    (*out)[i].getNormalVector3fMap() = (motion.linear() * cloud.normal[i].cast<double>()).cast<float>();
  }
  return out;
}

/// Counterparts within distance and normal gate, not yet trimmed.
pcl::Correspondences Match(const PclCloud::Ptr& moved, const PclCloud::Ptr& target,
                           const pcl::search::KdTree<pcl::PointNormal>::Ptr& tree, const Stage& gate) {
  pcl::registration::CorrespondenceEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setInputSource(moved);
  estimation.setInputTarget(target);
  estimation.setSearchMethodTarget(tree, true);  // true: never rebuilt
  pcl::Correspondences near;
  estimation.determineCorrespondences(near, gate.distance_mm);

  pcl::registration::CorrespondenceRejectorSurfaceNormal normals;
  normals.initializeDataContainer<pcl::PointNormal, pcl::PointNormal>();
  normals.setInputSource<pcl::PointNormal>(moved);
  normals.setInputNormals<pcl::PointNormal, pcl::PointNormal>(moved);
  normals.setInputTarget<pcl::PointNormal>(target);
  normals.setTargetNormals<pcl::PointNormal, pcl::PointNormal>(target);
  normals.setThreshold(std::cos(gate.normals_deg * std::numbers::pi / 180));
  pcl::Correspondences alike;
  normals.getRemainingCorrespondences(near, alike);
  return alike;
}

pcl::Correspondences Trim(const pcl::Correspondences& pairs) {
  pcl::registration::CorrespondenceRejectorTrimmed trimmed;
  trimmed.setOverlapRatio(kTrim);
  pcl::Correspondences kept;
  trimmed.getRemainingCorrespondences(pairs, kept);
  // The rejector leaves them partly sorted; the patch's order makes every sum the same on every run.
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.index_query < b.index_query; });
  return kept;
}

/// One step of point-to-plane least squares, linearised about the middle of the pairs: about the camera, two metres
/// away, it would not converge.
Eigen::Isometry3d Step(const PclCloud& moved, const PclCloud& target, const pcl::Correspondences& pairs) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& pair : pairs) middle += moved[pair.index_query].getVector3fMap().cast<double>();
  middle /= static_cast<double>(pairs.size());
  PclCloud from, to;
  from.reserve(pairs.size());
  to.reserve(pairs.size());
  for (const auto& pair : pairs) {
    from.push_back(moved[pair.index_query]);
    to.push_back(target[pair.index_match]);
    from.back().getVector3fMap() -= middle.cast<float>();
    to.back().getVector3fMap() -= middle.cast<float>();
  }
  const pcl::registration::TransformationEstimationPointToPlaneLLS<pcl::PointNormal, pcl::PointNormal, double> solver;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  solver.estimateRigidTransformation(from, to, matrix);
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  if (!matrix.allFinite()) return step;
  step.linear() = Eigen::Quaterniond(matrix.topLeftCorner<3, 3>()).normalized().toRotationMatrix();
  step.translation() = matrix.topRightCorner<3, 1>() + middle - step.linear() * middle;
  return step;
}

/// How far a step moves points within 100 mm of the patch's middle, mm.
double Reach(const Eigen::Isometry3d& step, const Eigen::Vector3d& middle) {
  return (step * middle - middle).norm() + 100 * Eigen::AngleAxisd(step.linear()).angle();
}

}  // namespace

Result<Cloud> WithNormals(const Points& points, double radius_mm) try {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pcl::PointCloud<pcl::PointXYZ>::Ptr input(new pcl::PointCloud<pcl::PointXYZ>);
  input->reserve(points.size());
  for (const auto& p : points) input->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
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
    if (normal.dot(points[i]) > 0) normal = -normal;
    cloud.point.push_back(points[i]);
    cloud.normal.push_back(normal.normalized());
  }
  return cloud;
} catch (const std::exception& e) {
  return Fail(ErrorCode::kInternal, std::string("normals of the surface could not be computed: ") + e.what());
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

struct Target::Impl {
  PclCloud::Ptr cloud;
  Field field;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree;
};

Target::Target(Cloud cloud) : impl_(std::make_unique<Impl>()) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  impl_->cloud = ToPcl(cloud, Eigen::Isometry3d::Identity());
  for (const auto& p : cloud.point) impl_->field.Include(p);
  impl_->tree.reset(new pcl::search::KdTree<pcl::PointNormal>(false));
  impl_->tree->setInputCloud(impl_->cloud);
}
Target::~Target() = default;
Target::Target(Target&&) noexcept = default;
Target& Target::operator=(Target&&) noexcept = default;

Eigen::Isometry3d Target::Align(const Cloud& patch, const Eigen::Isometry3d& start,
                                std::span<const Stage> stages) const {
  Eigen::Isometry3d motion = start;
  for (const Stage& stage : stages) {
    for (int i = 0; i < stage.iterations; ++i) {
      const PclCloud::Ptr moved = ToPcl(patch, motion);
      const pcl::Correspondences pairs = Trim(Match(moved, impl_->cloud, impl_->tree, stage));
      if (pairs.size() < kLeastPairs) return motion;
      const Eigen::Isometry3d step = Step(*moved, *impl_->cloud, pairs);
      const Eigen::Vector3d middle = (*moved)[pairs[pairs.size() / 2].index_query].getVector3fMap().cast<double>();
      motion = step * motion;
      if (Reach(step, middle) < 0.01) break;
    }
  }
  return motion;
}

Fit Target::Judge(const Cloud& patch, const Eigen::Isometry3d& target_from_patch, double distance_mm) const {
  Fit fit;
  fit.target_from_patch = target_from_patch;
  const PclCloud::Ptr moved = ToPcl(patch, target_from_patch);
  const pcl::Correspondences matched = Match(moved, impl_->cloud, impl_->tree, {distance_mm, kJudgedNormalsDeg, 1});
  // A point whose skin is turned more than 75 degrees from the camera, or that has left the lit field, cannot have a
  // counterpart.
  std::vector<char> visible(moved->size());
  std::size_t visible_count = 0, found = 0;
  for (std::size_t i = 0; i < moved->size(); ++i) {
    const Eigen::Vector3f point = (*moved)[i].getVector3fMap();
    const bool faces = -point.normalized().dot((*moved)[i].getNormalVector3fMap()) > 0.26F;
    visible[i] = faces && impl_->field.Shows(point) ? 1 : 0;
    visible_count += static_cast<std::size_t>(visible[i]);
  }
  // Without a counterpart a hidden point costs a little, so that hiding the patch is no way to fit it.
  const auto cost = [&](std::size_t i) { return visible[i] != 0 ? 1.0 : kHiddenCost; };
  double loss = 0;
  for (std::size_t i = 0; i < moved->size(); ++i) loss += cost(i);
  for (const auto& pair : matched) {
    const auto i = static_cast<std::size_t>(pair.index_query);
    loss += pair.distance / (distance_mm * distance_mm) - cost(i);  // PCL's distance is squared
    found += static_cast<std::size_t>(visible[i]);
  }
  if (patch.size() == 0 || visible_count == 0 || matched.empty()) return fit;
  fit.loss = loss / static_cast<double>(patch.size());
  fit.visible = static_cast<double>(visible_count) / static_cast<double>(patch.size());
  fit.overlap = static_cast<double>(found) / static_cast<double>(visible_count);
  double squares = 0;
  for (const auto& pair : Trim(matched)) {
    const auto& target = (*impl_->cloud)[pair.index_match];
    fit.pairs.push_back({(*moved)[pair.index_query].getVector3fMap().cast<double>(),
                         target.getVector3fMap().cast<double>(), target.getNormalVector3fMap().cast<double>()});
    squares += fit.pairs.back().ToPlane() * fit.pairs.back().ToPlane();
  }
  if (!fit.pairs.empty()) fit.residual_mm = std::sqrt(squares / static_cast<double>(fit.pairs.size()));
  return fit;
}

}  // namespace striae::head::detail
