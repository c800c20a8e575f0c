#include "reconstruct/detail/target_pose.h"

#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

namespace striae::reconstruct::detail {

std::optional<Pose> PoseOf(const SquareCorners& corners, double side_mm) {
  const double h = side_mm / 2;
  const std::vector<cv::Point3d> square = {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<cv::Point2d> seen;
  for (const Eigen::Vector2d& c : corners) seen.emplace_back(c.x(), c.y());
  std::vector<cv::Mat> turns, shifts;
  std::vector<double> errors;
  const int count = cv::solvePnPGeneric(square, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts, false,
                                        cv::SOLVEPNP_IPPE_SQUARE, cv::noArray(), cv::noArray(), errors);
  if (count < 1) return std::nullopt;
  cv::solvePnPRefineLM(square, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns[0], shifts[0]);
  cv::Mat rotation;
  cv::Rodrigues(turns[0], rotation);
  std::vector<cv::Point2d> posed;
  cv::projectPoints(square, turns[0], shifts[0], cv::Mat::eye(3, 3, CV_64F), cv::noArray(), posed);
  Pose pose{{shifts[0].at<double>(0), shifts[0].at<double>(1), shifts[0].at<double>(2)},
            {rotation.at<double>(0, 2), rotation.at<double>(1, 2), rotation.at<double>(2, 2)},
            0};
  for (std::size_t k = 0; k < 4; ++k) {
    pose.misfit += (Eigen::Vector2d(posed[k].x, posed[k].y) - corners[k]).squaredNorm() / 4;
  }
  pose.misfit = std::sqrt(pose.misfit);
  if (pose.normal.dot(pose.middle) > 0) pose.normal = -pose.normal;
  return pose.middle.z() > 0 ? std::optional(pose) : std::nullopt;
}

double DepthUncertainty(const SquareCorners& corners, double side_mm, const Pose& pose, double corner_sd) {
  double variance = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (int axis = 0; axis < 2; ++axis) {
      auto moved = corners;
      moved[k][axis] += corner_sd;
      const auto other = PoseOf(moved, side_mm);
      if (other) variance += std::pow(other->middle.z() - pose.middle.z(), 2);
    }
  }
  return std::sqrt(variance);
}

}  // namespace striae::reconstruct::detail
