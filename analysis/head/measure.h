// How a head is turned against the torso, from two captures of one person: the neutral pose and another one.
//
// Head and torso are found in the neutral capture only; each patch is then registered to the whole other capture, and
// R = R_torso^T R_head. Angles are never subtracted from one another.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "analysis/head/regions.h"
#include "core/measurement.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::head {

struct Options {
  /// Drawn on the neutral photograph instead of found; kept in the result.
  Regions regions;
  /// Where the top of the subject's head points in the neutral capture's camera frame.
  Eigen::Vector3d up_in_camera{0, -1, 0};
  /// Spacing to which captures are thinned on the sensor grid, mm: 2 mm halved the error of 5 mm in trials.
  double spacing_mm = 2.0;
  /// Share of a patch's points, of those that face the camera after the motion, that must find their counterpart.
  double least_overlap = 0.8;
  /// Largest root mean square distance (point to plane) of the counterparts, mm; 2.5 times what the surfaces state as
  /// their own uncertainty where that is less, but not below 0.7 mm. One person's fits left 0.1 to 0.55 mm in trials,
  /// those of others 0.9 mm and more (torso).
  double largest_residual_mm = 1.2;
  /// Smallest resistance of a patch against being turned: root mean square shift along the normals for a turn of
  /// 1 rad about the weakest axis, mm. Zero for a sphere, whose noise alone resists by twice or three times the
  /// residual: seven times are asked for besides.
  double least_observability_mm = 2.5;
  /// Standard uncertainty of the camera's axes as the subject's axes, about each axis.
  double axes_sd_deg = 2.0;
  /// Part of every angle's uncertainty that neither resampling nor the residuals show: field curvature of the
  /// calibration.
  double floor_sd_deg = 0.05;
  /// Of absolute angles: people's faces and chests are asymmetric, and their profiles slope differently.
  double symmetry_sd_deg = 3.0, profile_sd_deg = 9.0;
  int resamples = 200;  ///< of the block bootstrap
  std::uint64_t seed = 1;
};

/// A part of the neutral capture laid onto the other one.
struct FittedPart {
  Eigen::Isometry3d pose_from_neutral = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3f> point_in_pose;  ///< the patch after the motion, where it has a counterpart; mm
  std::vector<float> residual_mm;              ///< along the normal, positive towards the camera; one per point
};

/// What the fits came to, for pictures.
struct HeadFits {
  FittedPart head, torso;
  Eigen::Vector3d neck_in_camera = Eigen::Vector3d::Zero();  ///< neutral capture, about the middle of the neck
  Eigen::Matrix3d subject_from_camera = Eigen::Matrix3d::Identity();
};

/// Both surfaces in mm in their own camera's frame, from the same device or not; vertices with or without sensor grid.
/// Measurements: rotation, flexion, tilt, total_angle (deg); details: rotation_matrix (3x3 rows, neutral camera
/// frame, takes a head vector of the neutral pose to the new pose), axes_source, sequence, residual_mm, overlap,
/// observability_mm for head and torso, words, TWSTRS bands where they have degrees, registration_uncertainty (without
/// the axes' part), and the regions in the neutral capture's pixels with their origin (found or drawn).
/// kMeasurementRefused when no head or torso is found, a patch does not fit or slides freely, or the head moved too far
/// against the torso to be the same body. Beyond a tilt of 80 deg the angles are flagged.
/// kUsage for options that cannot be meant. `fits` is filled where it is given and the measurement succeeds. Same
/// result for any number of threads.
Result<AnalysisReport> Measure(const Surface& neutral, const Surface& pose, const Options& options = {},
                               HeadFits* fits = nullptr);

}  // namespace striae::head
