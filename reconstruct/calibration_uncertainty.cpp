#include "reconstruct/calibration_uncertainty.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/optics.h"

namespace striae::reconstruct {
namespace {

struct Seen {
  Eigen::Vector2d pixel;
  double order;  ///< stripes
};

double DepthOf(const Calibration& calibration, const StripeOptics& optics, const Seen& seen) {
  return optics.DepthAt(RayOf(calibration.camera, seen.pixel), seen.order).value_or(std::nan(""));
}

/// Depth of every point with one parameter moved, less that with it moved the other way.
std::vector<double> Difference(Calibration calibration, const std::string& name, double step,
                               const std::vector<Seen>& points) {
  double& value = *CalibrationParameter(calibration, name);
  const double middle = value;
  std::vector<double> difference(points.size(), 0);
  for (const double way : {1.0, -1.0}) {
    value = middle + way * step;
    const StripeOptics optics(calibration);
    for (std::size_t i = 0; i < points.size(); ++i) difference[i] += way * DepthOf(calibration, optics, points[i]);
  }
  return difference;
}

}  // namespace

std::optional<CalibrationDepthUncertainty> DepthUncertaintyOf(const Calibration& calibration,
                                                              const std::vector<PixelDepth>& points) {
  if (!calibration.uncertainty) return std::nullopt;
  const StripeOptics optics(calibration);
  std::vector<Seen> seen;
  for (const PixelDepth& point : points) {
    const Eigen::Vector2d pixel(point.col, point.row);
    const auto order = optics.OrderAt(point.depth_mm * RayOf(calibration.camera, pixel));
    if (order) seen.push_back({pixel, *order});
  }
  const auto& [names, covariance] = *calibration.uncertainty;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(seen.size()), covariance.rows());
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    // As far as the parameter may be off: there the depth is straight, and far from rounding.
    const double step = std::sqrt(covariance(i, i));
    if (!(step > 0)) continue;
    const auto difference = Difference(calibration, names[static_cast<std::size_t>(i)], step, seen);
    for (std::size_t k = 0; k < seen.size(); ++k)
      jacobian(static_cast<Eigen::Index>(k), i) = difference[k] / (2 * step);
  }
  std::vector<double> uncertainties;
  for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
    const double variance = jacobian.row(k) * covariance * jacobian.row(k).transpose();
    if (std::isfinite(variance)) uncertainties.push_back(std::sqrt(std::max(0.0, variance)));
  }
  if (uncertainties.empty()) return std::nullopt;
  std::sort(uncertainties.begin(), uncertainties.end());
  return CalibrationDepthUncertainty{uncertainties[uncertainties.size() / 2], uncertainties.back()};
}

}  // namespace striae::reconstruct
