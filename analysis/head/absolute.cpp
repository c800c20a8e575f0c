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

/// Unit normal of the symmetry plane towards the subject's right, camera axes.
std::optional<Eigen::Vector3d> SymmetryNormal(const Fit& of_mirror_image, const Eigen::Vector3d& right) {
  Eigen::Matrix3d reflection = of_mirror_image.target_from_patch.linear();
  reflection.col(0) *= -1;  // the mirror image was made by x -> -x
  // For an exact reflection I - 2 n n^T; else the symmetric part's least eigenvector is the nearest.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver((reflection + reflection.transpose()) / 2);
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (solver.eigenvalues()[0] > -kLeastPlane) return std::nullopt;
  if (normal.dot(right) < 0) normal = -normal;
  return normal;
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

  const Patch torso_patch = detail::Mirrored(detail::MakePatch(fine, parts->torso));
  const Fit torso = detail::FitTorso(torso_patch, target, Eigen::Vector3d::Zero());
  if (auto judged = JudgeSymmetry(torso, "torso"); !judged) return Fail(judged.error());
  const Patch face = detail::MakePatch(fine, parts->head);
  const Patch head_patch = detail::Mirrored(face);
  const Fit head =
      detail::FitHead(head_patch, target, Eigen::Isometry3d::Identity(), parts->neck_in_camera, subject_from_camera);
  if (auto judged = JudgeSymmetry(head, "head"); !judged) return Fail(judged.error());
  const auto torso_right = SymmetryNormal(torso, right), head_right = SymmetryNormal(head, right);
  if (!torso_right || !head_right) {
    return Fail(ErrorCode::kMeasurementRefused, "no symmetry plane was found: take a neutral capture");
  }

  // Mirrored was about the face's own middle, which that leaves where it is; halfway to where it was laid is the plane.
  const Eigen::Vector3d middle = detail::Middle(face.coarse);
  const Eigen::Vector3d on_plane = (middle + head.target_from_patch * middle) / 2;
  const bool are_given = options.regions.brow_px && options.regions.chin_px;
  std::optional<detail::Profile> profile;
  if (!are_given) {
    profile = detail::FacialLine(fine, on_plane, *head_right, subject_from_camera.row(1).transpose());
  } else if (const auto brow = detail::PointAt(fine, *options.regions.brow_px),
             chin = detail::PointAt(fine, *options.regions.chin_px);
             brow && chin) {
    profile = detail::Profile{*brow, *chin};
  }
  if (!profile || (profile->brow - profile->chin).norm() < 30) {
    return Fail(ErrorCode::kMeasurementRefused,
                "chin and brow are not both measured: give them as chin_px and brow_px");
  }
  const Eigen::Matrix3d torso_frame = Frame(*torso_right, options.up_in_camera.normalized());
  const Eigen::Matrix3d head_frame = Frame(*head_right, profile->brow - profile->chin);
  return detail::AbsoluteReport(head, torso, torso_frame.transpose() * head_frame, are_given, options);
}

}  // namespace striae::head
