#include "reconstruct/detail/target_pose.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include "core/optics.h"

namespace striae::reconstruct::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kOnSides = 8;                    ///< two places on each side
using Unknowns = Eigen::Matrix<double, 6, 1>;  ///< Rodrigues vector, place of the middle (mm)
using Residuals = Eigen::Matrix<double, kOnSides + 2, 1>;

struct Seen {
  const Sides& sides;
  double side_mm;
  Vector2d tilt;  ///< x and y of the normal that is expected
  double tilt_sd;
};

/// The square's places before the lines and the expected tilt, in units of their sd.
Residuals ResidualsOf(const Unknowns& pose, const Seen& label) {
  const auto& [sides, side_mm, tilt, tilt_sd] = label;
  const Eigen::Matrix3d turned = RotationFromRodrigues(pose.head<3>());
  const double h = side_mm / 2;
  const std::array<Vector3d, 4> corner = {Vector3d(-h, h, 0), Vector3d(h, h, 0), Vector3d(h, -h, 0),
                                          Vector3d(-h, -h, 0)};
  Residuals out;
  for (std::size_t k = 0; k < 4; ++k) {
    for (const std::size_t end : {0U, 1U}) {
      const Vector3d on_side = corner[k] + (end == 0 ? 0.15 : 0.85) * (corner[(k + 1) % 4] - corner[k]);
      const Vector3d seen = turned * on_side + pose.tail<3>();
      out[static_cast<Eigen::Index>(2 * k + end)] =
          (sides[k].normal.dot(seen.head<2>() / seen.z()) - sides[k].offset) / sides[k].sd;
    }
  }
  out[kOnSides] = (turned(0, 2) - tilt.x()) / tilt_sd;
  out[kOnSides + 1] = (turned(1, 2) - tilt.y()) / tilt_sd;
  return out;
}

Eigen::Matrix<double, kOnSides + 2, 6> JacobianOf(const Unknowns& pose, const Seen& label) {
  Eigen::Matrix<double, kOnSides + 2, 6> jacobian;
  for (int i = 0; i < 6; ++i) {
    const double step = i < 3 ? 1e-6 : 1e-4;
    Unknowns up = pose, down = pose;
    up[i] += step;
    down[i] -= step;
    jacobian.col(i) = (ResidualsOf(up, label) - ResidualsOf(down, label)) / (2 * step);
  }
  return jacobian;
}

std::optional<Unknowns> StartOf(const SquareCorners& corners, double side_mm) {
  const double h = side_mm / 2;
  const std::vector<cv::Point3d> square = {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<cv::Point2d> seen;
  for (const Vector2d& c : corners) seen.emplace_back(c.x(), c.y());
  std::vector<cv::Mat> turns, shifts;
  if (cv::solvePnPGeneric(square, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts, false,
                          cv::SOLVEPNP_IPPE_SQUARE) < 1) {
    return std::nullopt;
  }
  Unknowns pose;
  for (int i = 0; i < 3; ++i) {
    pose[i] = turns[0].at<double>(i);
    pose[i + 3] = shifts[0].at<double>(i);
  }
  return pose.allFinite() && pose[5] > 0 ? std::optional(pose) : std::nullopt;
}

}  // namespace

std::optional<SquareCorners> CornersOf(const Sides& sides) {
  SquareCorners corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const SideLine &a = sides[(k + 3) % 4], &b = sides[k];
    Eigen::Matrix2d normals;
    normals << a.normal.transpose(), b.normal.transpose();
    if (std::abs(normals.determinant()) < 0.2) return std::nullopt;
    corners[k] = normals.inverse() * Vector2d(a.offset, b.offset);
  }
  return corners;
}

std::optional<Pose> PoseOf(const Sides& sides, double side_mm, const std::optional<Vector3d>& expected) {
  constexpr double kFaces = 0.5, kKnown = 0.03;  // sine of the tilt, sd
  const Seen label{sides, side_mm, expected ? Vector2d(expected->head<2>()) : Vector2d(Vector2d::Zero()),
                   expected ? kKnown : kFaces};
  const auto corners = CornersOf(sides);
  auto start = corners ? StartOf(*corners, side_mm) : std::nullopt;
  if (!start) return std::nullopt;
  Unknowns pose = *start;
  double damping = 1e-3, cost = ResidualsOf(pose, label).squaredNorm();
  for (int round = 0; round < 60; ++round) {
    const auto jacobian = JacobianOf(pose, label);
    Eigen::Matrix<double, 6, 6> normal = jacobian.transpose() * jacobian;
    normal.diagonal() *= 1 + damping;
    const Unknowns next = pose - normal.ldlt().solve(jacobian.transpose() * ResidualsOf(pose, label));
    const double next_cost = ResidualsOf(next, label).squaredNorm();
    if (!(next_cost < cost)) {
      damping *= 10;
      continue;
    }
    damping /= 10;
    pose = next;
    cost = next_cost;
  }
  const auto jacobian = JacobianOf(pose, label);
  const Eigen::Matrix<double, 6, 6> covariance = (jacobian.transpose() * jacobian).inverse();
  if (!covariance.allFinite() || pose[5] <= 0) return std::nullopt;
  Pose found;
  found.middle = pose.tail<3>();
  found.normal = RotationFromRodrigues(pose.head<3>()).col(2);
  if (found.normal.dot(found.middle) > 0) found.normal = -found.normal;
  found.depth_sd_mm = std::sqrt(covariance(5, 5));
  found.misfit = std::sqrt(cost / kOnSides);
  return found;
}

}  // namespace striae::reconstruct::detail
