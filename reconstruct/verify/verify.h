// Acceptance test and reverification of the rig after VDI/VDE 2634 part 2 (optical 3D measuring systems that measure an
// area): plane, ball, and two balls at a known distance. docs/verification.md defines each figure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/outline.h"
#include "core/result.h"
#include "core/study.h"
#include "core/surface.h"

namespace striae::reconstruct {

struct VerifyOptions {
  /// The artefact in sensor pixels; every point inside counts. Without it the artefact is looked for.
  std::optional<Outline> outline;
  /// Share of the points, those farthest from the fit, that may be left out of the ranges (the guideline's limit).
  double rejected_share = 0.003;
  std::uint64_t seed = 1;  ///< of the search; the result hardly depends on it, and not at all for one value
};

/// Everything in mm, in the camera frame.
struct PlaneCheck {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< centre of the points
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the camera
  double flatness_mm = 0;                            ///< range of the signed distances after rejection
  double sd_mm = 0;                                  ///< standard deviation of all points, none rejected
  double length_mm = 0;                              ///< largest extent of the points within the plane
  std::size_t points = 0, rejected = 0;
};

/// Least-squares plane of the largest flat part. Points inside the convex hull (on the sensor) of that part count
/// whether they lie on the plane or not. kMeasurementRefused with the reason: too few points, nothing flat, or a shape
/// that leaves its flat part gradually (a limb is no plane); kOutlineOffSurface for an outline without points.
Result<PlaneCheck> CheckPlane(const Surface& surface, const VerifyOptions& options);

struct BallCheck {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double diameter_mm = 0;    ///< of the least-squares sphere, after rejection
  double form_mm = 0;        ///< PF: range of the radial distances after rejection
  double size_error_mm = 0;  ///< PS: diameter_mm less the calibrated diameter
  double sd_mm = 0;          ///< standard deviation of the radial distances of all points, none rejected
  double cap_deg = 0;        ///< half angle of the evaluated cap about the direction to the camera
  double filled = 0;         ///< share of the cap that has points
  std::size_t points = 0, rejected = 0;
};

/// Half angle of the cap of a ball that is evaluated: steeper parts have hardly any light and no neighbours.
inline constexpr double kBallCapDeg = 60;

/// Least-squares sphere with free radius of the ball of about `diameter_mm`. All points whose ray meets the ball's cap
/// count. The surface needs its sensor grid. kMeasurementRefused: no ball of that size, or too little of it visible;
/// kUsage for a diameter that is not positive; kOutlineOffSurface as above.
Result<BallCheck> CheckBall(const Surface& surface, double diameter_mm, const VerifyOptions& options);

struct DistanceCheck {
  BallCheck first, second;  ///< left to right on the sensor (top to bottom where they stand above each other)
  double distance_mm = 0;   ///< between the centres
  double error_mm = 0;      ///< SD: distance_mm less the calibrated distance
};

/// Two balls of about `diameter_mm` in one surface, their centres `distance_mm` apart.
Result<DistanceCheck> CheckDistance(const Surface& surface, double diameter_mm, double distance_mm,
                                    const VerifyOptions& options);

/// The range's limits when the user states none, mm: largest allowed flatness, |form|, |size| and |spacing| error.
struct Tolerances {
  double flatness_mm = 0, form_mm = 0, size_mm = 0, spacing_mm = 0;
};
Tolerances DefaultTolerances(RigRange range);
/// The range that a calibration is for: small up to 1.5 m (middle of its working distance), large beyond.
RigRange RangeAt(double distance_mm);

}  // namespace striae::reconstruct
