// What is believed of a rig before it is measured, and where beliefs end: the weak priors of the calibration.
#pragma once

#include <string>
#include <vector>

#include <ceres/ceres.h>

#include "reconstruct/calibrate/detail/order_residual.h"

namespace striae::reconstruct::detail {

enum Block { kCameraBlock, kProjectorBlock, kPoseBlock, kSlideBlock };
inline constexpr int kBlockSizes[] = {6, 9, 6, 2};
inline constexpr int kRigSize = 15, kAllSize = 23;  ///< camera and projector; with pose and slide

/// A weak belief about one parameter: (value - mean) / sigma.
struct Prior {
  Block block = kCameraBlock;
  int index = 0;
  double sigma = 1;
};

double* BlockOf(RigParameters& parameters, Block block);
const double* BlockOf(const RigParameters& parameters, Block block);

/// Of camera and projector, and with `slide` of the slide's direction. `axis` is across the stripes (0 or 1).
std::vector<Prior> Priors(const RigParameters& nominal, const ProjectorLaw& law, bool slide);

/// Adds each prior as a residual on its block.
void AddPriors(const std::vector<Prior>& priors, const RigParameters& nominal, RigParameters& parameters,
               ceres::Problem& problem);

/// Name of the camera's and projector's parameters in their order (camera first).
const char* RigParameterName(int index, ProjectorModel::Kind kind);

/// The first parameter more than `sigmas` of its prior from the design; empty when none is.
std::string FarFromDesign(const RigParameters& parameters, const RigParameters& nominal, const ProjectorLaw& law,
                          double sigmas);

/// Indices within the projector's block that a law does not have (angular: the rotation, k1 and the centre's place
/// along the stripes).
std::vector<int> FixedProjectorIndices(const ProjectorLaw& law);

}  // namespace striae::reconstruct::detail
