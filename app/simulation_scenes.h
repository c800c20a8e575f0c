// The scenes of `striae simulate`: bodies of known shape, and what is to be found on them.
#pragma once

#include <filesystem>

#include "acquire/rig/ball.h"
#include "acquire/rig/blocks.h"
#include "acquire/rig/bust.h"
#include "acquire/rig/limb.h"
#include "acquire/rig/plane.h"
#include "app/simulation.h"

namespace striae::app {

/// A limb with a wound that heals over `visits` photographs, each newly positioned; outlines beside.
Status SimulateLimb(const rig::LimbOptions& limb, int visits, Simulation& simulation);
/// The neutral bust, and the posed one when `pose` turns or moves anything. Both are dressed alike.
Status SimulateBust(const rig::BustOptions& pose, const Eigen::Vector3d& yaw_pitch_roll_deg, Simulation& simulation);
/// A plate of known plane.
Status SimulatePlane(const rig::PlaneOptions& plane, Simulation& simulation);
/// The reference plate on a slide away from the camera: reference.ply, steps.csv and its photographs.
Status SimulateSteps(int steps, double step_mm, Simulation& simulation);

struct BallScene {
  double radius_mm = 0;       ///< 0: 75 mm for each metre of distance
  double x_mm = 0, y_mm = 0;  ///< of the centre
};
/// A ball whose nearest point lies at the scene's distance, when it is in the middle.
Status SimulateBall(const BallScene& ball, Simulation& simulation);

/// Blocks on a plate that lies at the scene's distance, tilted.
Status SimulateBlocks(const rig::BlocksOptions& blocks, double tilt_x_deg, double tilt_y_deg, Simulation& simulation);

}  // namespace striae::app
