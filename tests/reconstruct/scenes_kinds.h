// Scenes that tempt the stripe order into a wrong whole number, each with rig, pose and light drawn from a seed.
#pragma once

#include <string>
#include <vector>

#include "tests/reconstruct/scenes_render.h"

namespace striae::testing {

struct OrderScene {
  std::string kind;
  BodyScene scene;
  double distance_mm = 0;  ///< what the code is told: off by up to half the working range either way
};

const std::vector<std::string>& OrderSceneKinds();
/// The kind's scene with everything else drawn from `seed`. `sensor` is the share of the D90's pixels a side.
/// std::out_of_range for an unknown kind.
OrderScene MakeOrderScene(const std::string& kind, std::uint32_t seed, double sensor);

}  // namespace striae::testing
