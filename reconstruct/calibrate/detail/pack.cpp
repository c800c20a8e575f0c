#include "reconstruct/calibrate/detail/pack.h"

#include <algorithm>
#include <cmath>

namespace striae::reconstruct::detail {
namespace {

constexpr double kHardlyToldApart = 0.99;
constexpr int kFocal = 12, kCentralOrder = 13;  ///< of camera and projector in one row

std::vector<int> Used(const ProjectorLaw& law) {
  const std::vector<int> fixed = FixedProjectorIndices(law);
  std::vector<int> used;
  for (int i = 0; i < kRigSize; ++i) {
    if (std::find(fixed.begin(), fixed.end(), i - kBlockSizes[0]) == fixed.end()) used.push_back(i);
  }
  return used;
}

double ValueOf(const RigParameters& p, int i) {
  return i < kBlockSizes[0] ? p.camera[i] : p.projector[i - kBlockSizes[0]];
}

}  // namespace

Calibration PackCalibration(const RigParameters& p, const ProjectorLaw& law, const NominalRig& nominal) {
  Calibration c;
  c.image_width_px = nominal.image_width_px;
  c.image_height_px = nominal.image_height_px;
  c.camera = {p.camera[0] * p.camera[1], p.camera[0], p.camera[2], p.camera[3], p.camera[4], p.camera[5], 0, 0};
  c.projector.kind = law.kind;
  c.projector.center_mm = Eigen::Map<const Eigen::Vector3d>(p.projector);
  c.direction = nominal.direction;
  if (law.kind == ProjectorModel::Kind::kAngular) {
    c.projector.a0_rad = -p.projector[7] / p.projector[6];
    c.projector.delta_a_rad = 1 / p.projector[6];
    return c;
  }
  c.projector.rotation_rodrigues = Eigen::Map<const Eigen::Vector3d>(p.projector + 3);
  c.projector.focal_stripes = p.projector[6];
  c.projector.center_order = p.projector[7];
  c.projector.k1 = p.projector[8];
  return c;
}

CalibrationUncertainty PackUncertainty(const Eigen::MatrixXd& covariance, const RigParameters& p,
                                       const ProjectorLaw& law) {
  static const char* const kPinhole[kRigSize] = {"camera.fy",
                                                 "camera.fx",
                                                 "camera.cx",
                                                 "camera.cy",
                                                 "camera.k1",
                                                 "camera.k2",
                                                 "projector.center_x",
                                                 "projector.center_y",
                                                 "projector.center_z",
                                                 "projector.rotation_x",
                                                 "projector.rotation_y",
                                                 "projector.rotation_z",
                                                 "projector.focal_stripes",
                                                 "projector.center_order",
                                                 "projector.k1"};
  const bool angular = law.kind == ProjectorModel::Kind::kAngular;
  Eigen::MatrixXd change = Eigen::MatrixXd::Identity(kRigSize, kRigSize);
  change(1, 0) = p.camera[1];  // fx = fy * (fx / fy)
  change(1, 1) = p.camera[0];
  if (angular) {
    const double f = p.projector[6], n0 = p.projector[7];
    change(kFocal, kFocal) = -1 / (f * f);         // delta_a = 1 / f
    change(kCentralOrder, kFocal) = n0 / (f * f);  // a0 = -n0 / f
    change(kCentralOrder, kCentralOrder) = -1 / f;
  }
  const Eigen::MatrixXd all = change * covariance.topLeftCorner(kRigSize, kRigSize) * change.transpose();
  const std::vector<int> used = Used(law);
  const auto size = static_cast<Eigen::Index>(used.size());
  CalibrationUncertainty uncertainty;
  uncertainty.covariance.resize(size, size);
  for (Eigen::Index row = 0; row < size; ++row) {
    const int i = used[static_cast<std::size_t>(row)];
    std::string name = kPinhole[i];
    if (angular && i == kFocal) name = "projector.delta_a_rad";
    if (angular && i == kCentralOrder) name = "projector.a0_rad";
    uncertainty.names.push_back(std::move(name));
    for (Eigen::Index col = 0; col < size; ++col) {
      const int k = used[static_cast<std::size_t>(col)];
      uncertainty.covariance(row, col) = (all(i, k) + all(k, i)) / 2;
    }
  }
  return uncertainty;
}

void ReportParameters(const Eigen::MatrixXd& covariance, const RigParameters& p, const ProjectorLaw& law,
                      std::vector<CalibrationFit::Parameter>& list,
                      std::vector<CalibrationFit::Correlation>& correlations) {
  const std::vector<int> used = Used(law);
  for (const int i : used) {
    list.push_back({RigParameterName(i, law.kind), ValueOf(p, i), std::sqrt(std::max(0.0, covariance(i, i)))});
  }
  for (const int i : used) {
    for (const int k : used) {
      const double scale = std::sqrt(covariance(i, i) * covariance(k, k));
      if (k <= i || !(scale > 0) || std::abs(covariance(i, k)) < kHardlyToldApart * scale) continue;
      correlations.push_back({RigParameterName(i, law.kind), RigParameterName(k, law.kind), covariance(i, k) / scale});
    }
  }
}

}  // namespace striae::reconstruct::detail
