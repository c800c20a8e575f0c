#include "analysis/head/detail/profile.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

namespace striae::head::detail {
namespace {

constexpr double kMidlineMm = 8, kFaceMm = 160;  // of the profile: to either side, and about the face's middle
constexpr int kFewest = 3;                       // points that make a landmark
constexpr double kLeastNoseMm = 9;               // before brow and chin; in adults 20 to 30
constexpr double kLeastUpright = 0.64;           // cosine of 50 deg: the most that a neck bends
constexpr double kSettledRad = 0.02;             // 1 deg: people's profiles differ by 9
constexpr double kForemostMm = 1.5;              // a landmark is the mean of what lies so far behind the foremost point
// Heights from the tip of the nose, adults and children: the brow stands 45 to 65 mm above it, chin and lower lip 35 to
// 75 mm below; whichever stands out more carries the line.
constexpr double kBrowMm[] = {35, 80}, kChinMm[] = {-95, -32};

/// The mean of the profile's foremost points between two heights; none where less than three are there.
std::optional<Eigen::Vector3d> Foremost(const std::vector<Eigen::Vector3d>& profile, const Eigen::Vector3d& up,
                                        const Eigen::Vector3d& forward, double from_mm, double to_mm) {
  double most = -std::numeric_limits<double>::infinity();
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto between = [&](const Eigen::Vector3d& p) { return p.dot(up) >= from_mm && p.dot(up) <= to_mm; };
  for (const auto& p : profile) {
    if (between(p)) most = std::max(most, p.dot(forward));
  }
  for (const auto& p : profile) {
    if (!between(p) || p.dot(forward) < most - kForemostMm) continue;
    sum += p;
    ++count;
  }
  if (count < kFewest) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

/// A line that rests on brow and chin, and how far the nose stands out before it.
struct Line {
  Profile landmarks;
  Eigen::Vector3d up;
  double nose_mm;
};

/// Repeats until the heights are those along the line itself; none where that does not settle.
std::optional<Line> Settle(const std::vector<Eigen::Vector3d>& profile, const Eigen::Vector3d& right,
                           Eigen::Vector3d up) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d forward = up.cross(right);
    const auto nose = Foremost(profile, up, forward, -60, 60);
    if (!nose) return std::nullopt;
    const double tip = nose->dot(up);
    const auto brow = Foremost(profile, up, forward, tip + kBrowMm[0], tip + kBrowMm[1]);
    const auto chin = Foremost(profile, up, forward, tip + kChinMm[0], tip + kChinMm[1]);
    if (!brow || !chin) return std::nullopt;
    const Eigen::Vector3d along = *brow - *chin;
    const Eigen::Vector3d next = (along - along.dot(right) * right).normalized();
    if ((next - up).norm() < kSettledRad) return Line{{*brow, *chin}, next, (*nose - *chin).dot(next.cross(right))};
    up = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Eigen::Vector3d> PointAt(const Cloud& cloud, const Eigen::Vector2d& pixel) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double far = (cloud.pixel[i].cast<double>() - pixel).squaredNorm();
    if (far < least) {
      least = far;
      best = i;
    }
  }
  if (!(least < 40 * 40)) return std::nullopt;
  return cloud.point[best].cast<double>();
}

std::optional<Profile> FacialLine(const Cloud& cloud, const Eigen::Vector3d& on_plane, const Eigen::Vector3d& right,
                                  const Eigen::Vector3d& up) {
  std::vector<Eigen::Vector3d> profile;
  for (const auto& point : cloud.point) {
    const Eigen::Vector3d p = point.cast<double>() - on_plane;
    if (std::abs(p.dot(right)) <= kMidlineMm && p.norm() <= kFaceMm) profile.push_back(p);
  }
  const Eigen::Vector3d upright = (up - up.dot(right) * right).normalized();
  const auto line = Settle(profile, right, upright);
  if (!line || line->up.dot(upright) < kLeastUpright || line->nose_mm < kLeastNoseMm) return std::nullopt;
  return line->landmarks;
}

}  // namespace striae::head::detail
