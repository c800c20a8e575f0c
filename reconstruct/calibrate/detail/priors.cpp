#include "reconstruct/calibrate/detail/priors.h"

#include <cmath>

namespace striae::reconstruct::detail {
namespace {

struct PriorResidual {
  PriorResidual(int index, double mean, double sigma) : index_(index), mean_(mean), sigma_(sigma) {}
  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    residual[0] = (blocks[0][index_] - mean_) / sigma_;
    return true;
  }
  int index_;
  double mean_, sigma_;
};

}  // namespace

double* BlockOf(RigParameters& p, Block block) {
  double* const blocks[] = {p.camera, p.projector, p.pose, p.slide};
  return blocks[block];
}

const double* BlockOf(const RigParameters& p, Block block) {
  const double* const blocks[] = {p.camera, p.projector, p.pose, p.slide};
  return blocks[block];
}

std::vector<Prior> Priors(const RigParameters& nominal, const ProjectorLaw& law, bool slide) {
  const double focal_stripes = nominal.projector[6];
  std::vector<Prior> priors = {{kCameraBlock, 0, 0.02 * nominal.camera[0]},
                               {kCameraBlock, 1, 0.005},
                               {kCameraBlock, 2, 50},
                               {kCameraBlock, 3, 50},
                               {kCameraBlock, 4, 0.1},
                               {kCameraBlock, 5, 0.1},
                               {kProjectorBlock, 1 - law.axis, 10},
                               {kProjectorBlock, law.axis, 20},
                               {kProjectorBlock, 2, 25}};
  if (law.kind == ProjectorModel::Kind::kAngular) {
    // The order at angle 0 holds the projector's tilt (0.05 rad) too.
    priors.push_back({kProjectorBlock, 6, 0.05 * focal_stripes});
    priors.push_back({kProjectorBlock, 7, 15 + 0.05 * focal_stripes});
  } else {
    const std::vector<Prior> pinhole = {{kProjectorBlock, 3, 0.05}, {kProjectorBlock, 4, 0.03},
                                        {kProjectorBlock, 5, 0.03}, {kProjectorBlock, 6, 0.02 * focal_stripes},
                                        {kProjectorBlock, 7, 15},   {kProjectorBlock, 8, 0.1}};
    priors.insert(priors.end(), pinhole.begin(), pinhole.end());
  }
  if (slide) priors.insert(priors.end(), {{kSlideBlock, 0, 0.1}, {kSlideBlock, 1, 0.1}});
  return priors;
}

void AddPriors(const std::vector<Prior>& priors, const RigParameters& nominal, RigParameters& parameters,
               ceres::Problem& problem) {
  for (const Prior& prior : priors) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<PriorResidual>(
        new PriorResidual(prior.index, BlockOf(nominal, prior.block)[prior.index], prior.sigma));
    cost->AddParameterBlock(kBlockSizes[prior.block]);
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, nullptr, BlockOf(parameters, prior.block));
  }
}

const char* RigParameterName(int index, ProjectorModel::Kind kind) {
  static const char* const kNames[kRigSize] = {"fy",
                                               "fx/fy",
                                               "cx",
                                               "cy",
                                               "k1",
                                               "k2",
                                               "center_x",
                                               "center_y",
                                               "center_z",
                                               "rotation_x",
                                               "rotation_y",
                                               "rotation_z",
                                               "focal_stripes",
                                               "center_order",
                                               "k1_projector"};
  if (kind == ProjectorModel::Kind::kAngular && index == 12) return "orders_per_rad";
  if (kind == ProjectorModel::Kind::kAngular && index == 13) return "order_at_0_rad";
  return kNames[index];
}

std::string FarFromDesign(const RigParameters& parameters, const RigParameters& nominal, const ProjectorLaw& law,
                          double sigmas) {
  for (const Prior& prior : Priors(nominal, law, false)) {
    // The central order's design value is a guess of the gauge.
    if (prior.block == kProjectorBlock && prior.index == 7) continue;
    const double value = BlockOf(parameters, prior.block)[prior.index];
    const double design = BlockOf(nominal, prior.block)[prior.index];
    if (std::abs(value - design) <= sigmas * prior.sigma) continue;  // false for NaN
    return std::string(RigParameterName(prior.index + (prior.block == kProjectorBlock ? 6 : 0), law.kind)) + " = " +
           std::to_string(value) + ", by design " + std::to_string(design);
  }
  return {};
}

std::vector<int> FixedProjectorIndices(const ProjectorLaw& law) {
  if (law.kind == ProjectorModel::Kind::kPinhole) return {};
  return {1 - law.axis, 3, 4, 5, 8};
}

}  // namespace striae::reconstruct::detail
