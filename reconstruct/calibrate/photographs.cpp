#include "reconstruct/calibrate/photographs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/optics.h"
#include "reconstruct/detail/parallel.h"
#include "reconstruct/order.h"

namespace striae::reconstruct {
namespace {

constexpr double kSamples = 20000;
constexpr int kRim_px = 6;               ///< along the stripes; across them the window reaches half a period
constexpr float kLargestBend_rad = 1.0;  ///< second difference of the phase over the rim's reach: beyond it is a step
constexpr double kLargestNoise_rad = 0.1;
/// The paper's rig reached 0.0005 to 0.0007 of the distance; a wrong mesh is off by far more.
constexpr double kLargestRobustShare = 0.001;
/// A photograph as a whole off by more than this share of the distance stood elsewhere (slides are good to 0.1 mm).
constexpr double kLargestShiftShare = 0.0005;

/// True where the sheet goes on, smoothly, for `reach` pixels to either side in a direction.
bool SmoothAlong(const PhaseResult& phase, int col, int row, int dx, int dy) {
  const auto same = [&](int x, int y) { return phase.mask.Contains(x, y) && phase.unwrapped.region(x, y) == 0; };
  const int reach = std::max(std::abs(dx), std::abs(dy));
  for (int i = -reach; i <= reach; ++i) {
    if (!same(col + i * dx / reach, row + i * dy / reach)) return false;
  }
  const ImageF& p = phase.unwrapped.phase;
  return std::abs(p(col - dx, row - dy) - 2 * p(col, row) + p(col + dx, row + dy)) < kLargestBend_rad;
}

double MedianOf(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

CalibrationView ViewFromPhase(const PhaseResult& phase, double position_mm) {
  CalibrationView view;
  view.position_mm = position_mm;
  const int width = phase.mask.width(), height = phase.mask.height();
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(phase.mask.size()) / kSamples)));
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  const int across = std::max(kRim_px, static_cast<int>(phase.carrier_period_px / 2));
  const int dx = horizontal ? kRim_px : across, dy = horizontal ? across : kRim_px;
  for (int row = step / 2; row < height; row += step) {
    for (int col = step / 2; col < width; col += step) {
      if (phase.unwrapped.region(col, row) != 0 || !phase.FitsAt(col, row)) continue;
      if (phase.noise > kLargestNoise_rad * static_cast<double>(phase.amplitude(col, row))) continue;
      if (!SmoothAlong(phase, col, row, dx, 0) || !SmoothAlong(phase, col, row, 0, dy)) continue;
      view.samples.push_back({{static_cast<double>(col), static_cast<double>(row)},
                              static_cast<double>(phase.unwrapped.phase(col, row)) / (2 * std::numbers::pi)});
    }
  }
  const auto edges = FindGratingEdges(phase, 1);
  if (edges.front().low) view.low_edge_order = edges.front().low->order;
  if (edges.front().high) view.high_edge_order = edges.front().high->order;
  return view;
}

DepthSpan ObjectSpan(const CalibrationFit& fit, const ReferenceShape& shape,
                     const std::vector<CalibrationView>& views) {
  DepthSpan span{std::numeric_limits<double>::max(), 0};
  for (const CalibrationView& view : views) {
    for (const OrderSample& sample : view.samples) {
      const auto depth =
          fit.ReferenceDepth(shape, RayOf(fit.calibration.camera, sample.pixel), view.position_mm, false);
      if (!depth) continue;
      span.near_mm = std::min(span.near_mm, *depth);
      span.far_mm = std::max(span.far_mm, *depth);
    }
  }
  return span;
}

Differences CompareWithReference(const Surface& surface, const CalibrationFit& fit, const ReferenceShape& shape,
                                 double position_mm) {
  if (!surface.HasGrid()) throw std::logic_error("CompareWithReference: the surface is not on the sensor's grid");
  const auto count = static_cast<int>(surface.size());
  std::vector<float> difference(surface.size(), std::numeric_limits<float>::quiet_NaN());
  detail::ParallelBlocks(
      count,
      [&](int, int first, int last) {
        for (int i = first; i < last; ++i) {
          const Eigen::Vector3d point = surface.point_in_camera[static_cast<std::size_t>(i)].cast<double>();
          const auto depth = fit.ReferenceDepth(shape, point / point.z(), position_mm, false, point.z());
          if (depth) difference[static_cast<std::size_t>(i)] = static_cast<float>(point.z() - *depth);
        }
      },
      4096);
  Differences result;
  const int cell = result.cell_px;
  result.map_mm =
      ImageF((surface.sensor_width_px + cell - 1) / cell, (surface.sensor_height_px + cell - 1) / cell, 0.0F);
  ImageF points(result.map_mm.width(), result.map_mm.height(), 0.0F);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (std::isnan(difference[i])) continue;
    result.values_mm.push_back(difference[i]);
    result.map_mm(surface.col[i] / cell, surface.row[i] / cell) += difference[i];
    points(surface.col[i] / cell, surface.row[i] / cell) += 1;
  }
  for (std::size_t i = 0; i < points.size(); ++i) result.map_mm.pixels()[i] /= points.pixels()[i];  // 0 / 0 = NaN
  return result;
}

Spread SpreadOf(std::vector<float> values) {
  Spread spread;
  spread.count = values.size();
  if (values.empty()) return spread;
  double sum = 0, squares = 0;
  for (const float value : values) sum += static_cast<double>(value);
  spread.mean = sum / static_cast<double>(values.size());
  for (const float value : values) squares += std::pow(static_cast<double>(value) - spread.mean, 2);
  spread.sd = std::sqrt(squares / static_cast<double>(values.size()));
  spread.median = MedianOf(values);
  for (float& value : values) value = std::abs(value - static_cast<float>(spread.median));
  spread.robust_sd = 1.4826 * MedianOf(values);
  return spread;
}

Status JudgeSpread(const Spread& all, const std::vector<Spread>& photographs, double distance_mm) {
  const auto refuse = [](const std::string& why) {
    return Fail(ErrorCode::kBadCalibration, "these photographs cannot calibrate the rig: " + why);
  };
  const auto millimetres = [](double value) { return std::to_string(value).substr(0, value < 0 ? 6 : 5) + " mm"; };
  if (all.count == 0) return refuse("no reconstructed point meets the reference; is it the right mesh?");
  for (std::size_t v = 0; v < photographs.size(); ++v) {
    if (photographs[v].count == 0) return refuse("photograph " + std::to_string(v + 1) + " shows nothing of the mesh");
    const double shift = photographs[v].median - all.median;
    if (std::abs(shift) > kLargestShiftShare * distance_mm) {
      return refuse("the surface in photograph " + std::to_string(v + 1) + " lies " + millimetres(shift) +
                    " off along the ray; check its position in the steps file");
    }
  }
  if (all.robust_sd > kLargestRobustShare * distance_mm) {
    return refuse("the surfaces differ from the mesh by " + millimetres(all.robust_sd) +
                  " (robust sd); is it the right mesh, in mm, x right, y down, relief towards the camera along -z?");
  }
  return {};
}

}  // namespace striae::reconstruct
