#include "reconstruct/target.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "core/optics.h"
#include "reconstruct/detail/target_pose.h"

namespace striae::reconstruct {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kModules = 6;        ///< along a label's side, its border included
constexpr double kLargestMisfit = 4;  ///< of what the sides are known to: a bent or half hidden label fits no plane
constexpr int kSamples = 41;          ///< profiles across each side
constexpr int kFewestPoints = 20;

/// 8 bit for the detector, brightened as sRGB is, so that dark skin and paper both show; at most about 1100 px wide.
cv::Mat Reduced(const ImageF& background, int factor) {
  std::vector<float> sample;
  for (std::size_t i = 0; i < background.size(); i += 101) sample.push_back(background.pixels()[i]);
  const auto top = sample.begin() + static_cast<long>(sample.size() - 1 - sample.size() / 200);
  std::nth_element(sample.begin(), top, sample.end());
  const float white = std::max(*top, 1e-6F);
  cv::Mat small(background.height() / factor, background.width() / factor, CV_8U);
  for (int row = 0; row < small.rows; ++row) {
    for (int col = 0; col < small.cols; ++col) {
      float sum = 0;
      for (int y = 0; y < factor; ++y) {
        const float* from = background.Row(row * factor + y) + static_cast<std::ptrdiff_t>(col) * factor;
        for (int x = 0; x < factor; ++x) sum += from[x];
      }
      const float light = std::clamp(sum / static_cast<float>(factor * factor) / white, 0.0F, 1.0F);
      small.at<std::uint8_t>(row, col) = static_cast<std::uint8_t>(std::lround(255 * std::pow(light, 1 / 2.2F)));
    }
  }
  return small;
}

struct Found {
  int id = 0;
  std::array<Vector2d, 4> corner;  ///< px, rough
};

double Area(const std::array<Vector2d, 4>& c) {
  const Vector2d a = c[2] - c[0], b = c[3] - c[1];
  return std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
}

std::optional<Found> Detect(const ImageF& background) {
  const int factor = std::max(1, background.width() / 1000);
  const cv::Mat small = Reduced(background, factor);
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000);
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->adaptiveThreshWinSizeMax = 53;
  parameters->errorCorrectionRate = 0;  // a thousand codes of 16 bits are too close for guessing
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(small, dictionary, corners, ids, parameters);
  std::optional<Found> best;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Found found{ids[i], {}};
    for (std::size_t k = 0; k < 4; ++k) {
      // A reduced pixel's centre lies in the middle of what it was made of.
      found.corner[k] = {(corners[i][k].x + 0.5) * factor - 0.5, (corners[i][k].y + 0.5) * factor - 0.5};
    }
    if (!best || Area(found.corner) > Area(best->corner)) best = found;
  }
  return best;
}

double Sampled(const ImageF& image, const Vector2d& at) {
  const double x = std::clamp(at.x(), 0.0, image.width() - 1.001), y = std::clamp(at.y(), 0.0, image.height() - 1.001);
  const int col = static_cast<int>(x), row = static_cast<int>(y);
  const double u = x - col, v = y - row;
  return (1 - v) * ((1 - u) * image(col, row) + u * image(col + 1, row)) +
         v * ((1 - u) * image(col, row + 1) + u * image(col + 1, row + 1));
}

/// Where the light rises through the half between ink and paper, along a profile across a side; `outwards` is one
/// module long.
std::optional<Vector2d> Step(const ImageF& image, const Vector2d& on_side, const Vector2d& outwards) {
  constexpr double kReach = 0.75;
  constexpr int kCount = 61;
  std::array<double, kCount> profile{};
  const auto place = [&](double i) { return Vector2d(on_side + (2 * i / (kCount - 1) - 1) * kReach * outwards); };
  for (int i = 0; i < kCount; ++i) profile[static_cast<std::size_t>(i)] = Sampled(image, place(i));
  const double ink = std::min({profile[0], profile[4], profile[8]});
  const double paper = std::max({profile[kCount - 1], profile[kCount - 5], profile[kCount - 9]});
  if (paper < 1.5 * ink) return std::nullopt;
  const double half = (ink + paper) / 2;
  std::optional<Vector2d> found;
  for (std::size_t i = 1; i < kCount; ++i) {
    if (profile[i - 1] >= half || profile[i] < half) continue;
    if (found) return std::nullopt;  // something else crosses here
    found = place(static_cast<double>(i) - 1 + (half - profile[i - 1]) / (profile[i] - profile[i - 1]));
  }
  return found;
}

/// A line through the points with the rms of its residuals as `sd`; stragglers are left out.
std::optional<SideLine> FitLine(std::vector<Vector2d> points) {
  SideLine line;
  for (int round = 0; round < 4; ++round) {
    if (static_cast<int>(points.size()) < kFewestPoints) return std::nullopt;
    Vector2d mean = Vector2d::Zero();
    for (const Vector2d& p : points) mean += p / static_cast<double>(points.size());
    double xx = 0, xy = 0, yy = 0;
    for (const Vector2d& p : points) {
      const Vector2d d = p - mean;
      xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    line.normal = {-std::sin(angle), std::cos(angle)};
    line.offset = line.normal.dot(mean);
    double sum = 0;
    for (const Vector2d& p : points) sum += std::pow(line.normal.dot(p) - line.offset, 2);
    line.sd = std::sqrt(sum / static_cast<double>(points.size()));
    const double most = std::max(2.5 * line.sd, 1e-9);
    std::erase_if(points, [&](const Vector2d& p) { return std::abs(line.normal.dot(p) - line.offset) > most; });
  }
  return line;
}

/// What a side's line is known to (px), `sd_px` being its points' scatter: dark stripes hide a side that runs along
/// them.
double SideUncertainty(const PhaseResult& phase, const Vector2d& side_px, double sd_px) {
  constexpr double kPixel = 0.3, kIndependent = 8, kHidden = 0.144;  // a quarter stripe either way, evenly: / sqrt(3)
  const bool along_rows = phase.direction == StripeDirection::kHorizontal;
  const double along = std::abs(along_rows ? side_px.x() : side_px.y()) / side_px.norm();
  const double stripes = std::abs(along_rows ? side_px.y() : side_px.x()) / phase.carrier_period_px;
  const double hidden = kHidden * phase.carrier_period_px * along / std::max(1.0, stripes);
  return std::hypot(kPixel, hidden, sd_px / std::sqrt(kIndependent));
}

/// The four sides on the plane z = 1 (lens distortion removed), from upper left to upper right and on clockwise;
/// nullopt when one does not show well. `found` becomes the lines' meetings.
std::optional<detail::Sides> SidesOf(const PhaseResult& phase, const CameraModel& camera, Found& found) {
  detail::Sides sides;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d from = found.corner[k], along = found.corner[(k + 1) % 4] - from;
      const Vector2d outwards = Vector2d(along.y(), -along.x()) / kModules;  // corners go clockwise on the sensor
      std::vector<Vector2d> points;
      for (int i = 0; i < kSamples; ++i) {
        const Vector2d on_side = from + (0.15 + 0.7 * i / (kSamples - 1)) * along;
        if (const auto step = Step(phase.background, on_side, outwards)) {
          points.emplace_back(RayOf(camera, *step).head<2>());
        }
      }
      const auto line = FitLine(std::move(points));
      if (!line) return std::nullopt;
      sides[k] = *line;
      sides[k].sd = SideUncertainty(phase, along, line->sd * camera.fx) / camera.fx;
    }
    const auto corners = detail::CornersOf(sides);
    if (!corners) return std::nullopt;
    for (std::size_t k = 0; k < 4; ++k) {
      found.corner[k] = Project(camera, {(*corners)[k].x(), (*corners)[k].y(), 1});
    }
  }
  return sides;
}

std::optional<TargetSighting> Find(const PhaseResult& phase, const CameraModel& camera, double side_mm) {
  auto found = Detect(phase.background);
  if (!found) return std::nullopt;
  const auto sides = SidesOf(phase, camera, *found);
  if (!sides) return std::nullopt;
  const auto pose = detail::PoseOf(*sides, side_mm);
  if (!pose || pose->misfit > kLargestMisfit) return std::nullopt;
  constexpr double kPrint = 0.001;  // a printer's scale
  TargetSighting sighting;
  sighting.marker_id = found->id;
  sighting.side_mm = side_mm;
  sighting.corner_px = found->corner;
  sighting.sides = *sides;
  sighting.middle_mm = pose->middle;
  sighting.normal = pose->normal;
  sighting.distance_sd_mm = std::hypot(pose->depth_sd_mm, kPrint * pose->middle.z());
  return sighting;
}

}  // namespace

std::optional<TargetSighting> FindTarget(const PhaseResult& phase, const CameraModel& camera, double side_mm) {
  if (phase.background.width() < 64 || phase.background.height() < 64 || !(side_mm > 0)) return std::nullopt;
  try {
    return Find(phase, camera, side_mm);
  } catch (const cv::Exception&) {
    return std::nullopt;  // OpenCV could make nothing of it: no label
  }
}

}  // namespace striae::reconstruct
