#include "analysis/head/absolute.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "analysis/head/angles.h"
#include "analysis/head/detail/prepare.h"
#include "analysis/head/detail/profile.h"
#include "analysis/head/detail/report.h"
#include "analysis/head/detail/search.h"

namespace striae::head {
namespace {

using detail::Capture;
using detail::Cloud;
using detail::Fit;
using detail::Patch;

constexpr double kLeastOverlap = 0.6;        // the far side of a turned face has no counterpart
constexpr double kLargestAsymmetryMm = 2.5;  // of people's faces and chests about 1 mm
constexpr double kLeastPlane = 0.94;         // cosine of 20 deg: a plane that is no reflection at all
constexpr double kLeastTurnCosine = 0.985;   // 10 deg about the plane's normal
constexpr double kLargestGlideMm = 15;

/// Symmetry plane in camera axes.
struct Plane {
  Eigen::Vector3d point, normal;  ///< the unit normal towards the subject's right
};

/// The plane at which `of_mirror_image` reflects a patch with that middle; none where the motion is no reflection: one
/// turns nothing about its normal, and shifts nothing within its plane.
std::optional<Plane> SymmetryPlane(const Fit& of_mirror_image, const Eigen::Vector3d& middle,
                                   const Eigen::Vector3d& right) {
  Eigen::Matrix3d reflection = of_mirror_image.target_from_patch.linear();
  reflection.col(0) *= -1;  // the mirror image was made by x -> -x
  // For an exact reflection I - 2 n n^T; else the symmetric part's least eigenvector is the nearest.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver((reflection + reflection.transpose()) / 2);
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (normal.dot(right) < 0) normal = -normal;
  // The mirror image was made about the patch's own middle, which that left where it was.
  const Eigen::Vector3d shift = of_mirror_image.target_from_patch * middle - middle;
  const double within = (shift - shift.dot(normal) * normal).norm();
  const double turn_cosine = (reflection.trace() + 1) / 2;
  if (solver.eigenvalues()[0] > -kLeastPlane || turn_cosine < kLeastTurnCosine || within > kLargestGlideMm) {
    return std::nullopt;
  }
  return Plane{middle + shift / 2, normal};
}

Status JudgeSymmetry(const Fit& fit, const std::string& part) {
  if (fit.pairs.size() >= 100 && fit.overlap >= kLeastOverlap && fit.residual_mm <= kLargestAsymmetryMm) return {};
  char text[120];
  std::snprintf(text, sizeof text, " does not fit its own mirror image (overlap %.2f, %.1f mm left)", fit.overlap,
                fit.residual_mm);
  return Fail(ErrorCode::kMeasurementRefused,
              "the " + part + text + ": take a neutral capture, or show both sides of face and chest");
}

Eigen::Matrix3d Frame(const Eigen::Vector3d& right, const Eigen::Vector3d& about_up) {
  Eigen::Matrix3d frame;
  frame.col(2) = right;
  frame.col(1) = (about_up - about_up.dot(right) * right).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

}  // namespace

Result<AnalysisReport> MeasureAbsolute(const Surface& capture, const Options& options) {
  if (auto checked = detail::Check(options); !checked) return Fail(checked.error());
  const Eigen::Matrix3d subject_from_camera = SubjectFromCamera(options.up_in_camera);
  auto clouds = detail::Prepare(capture, options.spacing_mm, "only");
  if (!clouds) return Fail(clouds.error());
  const Cloud fine = clouds->first;
  const auto parts = detail::Segment(fine, subject_from_camera, options.regions);
  if (!parts) return Fail(parts.error());
  const Capture target{detail::Target(std::move(clouds->second)), detail::Target(std::move(clouds->first))};
  const Eigen::Vector3d right = subject_from_camera.row(2).transpose();

  const Patch chest = detail::MakePatch(fine, parts->torso), face = detail::MakePatch(fine, parts->head);
  const Fit torso = detail::FitTorso(detail::Mirrored(chest), target, Eigen::Vector3d::Zero());
  if (auto judged = JudgeSymmetry(torso, "torso"); !judged) return Fail(judged.error());
  const Fit head = detail::FitHead(detail::Mirrored(face), target, Eigen::Isometry3d::Identity(), parts->neck_in_camera,
                                   subject_from_camera);
  if (auto judged = JudgeSymmetry(head, "head"); !judged) return Fail(judged.error());
  const auto torso_plane = SymmetryPlane(torso, detail::Middle(chest.coarse), right);
  const auto head_plane = SymmetryPlane(head, detail::Middle(face.coarse), right);
  if (!torso_plane || !head_plane) {
    return Fail(ErrorCode::kMeasurementRefused, "no symmetry plane was found: take a neutral capture");
  }

  const bool are_given = options.regions.brow_px && options.regions.chin_px;
  std::optional<detail::Profile> profile;
  if (!are_given) {
    profile = detail::FacialLine(fine, head_plane->point, head_plane->normal, subject_from_camera.row(1).transpose());
  } else if (const auto brow = detail::PointAt(fine, *options.regions.brow_px),
             chin = detail::PointAt(fine, *options.regions.chin_px);
             brow && chin) {
    profile = detail::Profile{*brow, *chin};
  }
  if (!profile || (profile->brow - profile->chin).norm() < 30) {
    return Fail(ErrorCode::kMeasurementRefused,
                "chin and brow are not both measured: give them as chin_px and brow_px");
  }
  const Eigen::Matrix3d torso_frame = Frame(torso_plane->normal, options.up_in_camera.normalized());
  const Eigen::Matrix3d head_frame = Frame(head_plane->normal, profile->brow - profile->chin);
  return detail::AbsoluteReport(head, torso, torso_frame.transpose() * head_frame, are_given, options);
}

}  // namespace striae::head
