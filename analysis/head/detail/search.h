// Registers the two patches of the neutral capture to the other capture, from many starts.
#pragma once

#include "analysis/head/detail/registration.h"
#include "analysis/head/detail/segment.h"

namespace striae::head::detail {

/// The other capture, coarse (6 mm, for choosing among starts) and fine.
struct Capture {
  Target coarse, fine;
};

/// A patch of the neutral capture in the same two densities.
struct Patch {
  Cloud coarse, fine;
};

/// Starts: the torso where it was, turned by up to 25 degrees, shifted by `shift` or not.
Fit FitTorso(const Patch& torso, const Capture& capture, const Eigen::Vector3d& shift);

/// Starts: a grid of turns of the head about the neck, on top of the torso's motion: to 60 degrees of rotation, 30 of
/// flexion and tilt, so that the basin of every clinical pose is entered (one start alone went wrong in 8 of 12 poses
/// of 30 degrees).
Fit FitHead(const Patch& head, const Capture& capture, const Eigen::Isometry3d& torso_motion,
            const Eigen::Vector3d& neck, const Eigen::Matrix3d& subject_from_camera);

}  // namespace striae::head::detail
