#include "analysis/head/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <Eigen/Geometry>

#include "analysis/head/angles.h"
#include "analysis/head/detail/prepare.h"
#include "analysis/head/detail/report.h"
#include "analysis/head/detail/search.h"
#include "analysis/head/detail/uncertainty.h"

namespace striae::head {
namespace {

using detail::Capture;
using detail::Fit;
using detail::Patch;

constexpr double kLargestNeckMoveMm = 110;  // protraction or side shift of a neck; one stripe in depth is 135 mm
constexpr double kLeastVisible = 0.4;
// What fits this closely is the same skin; the rest of it may be a stripe out of order, or under hair by now.
constexpr double kCloselyMm = 0.4, kOverlapForgiven = 0.15;
constexpr double kSurelyOneMm = 0.7;  // breath, expression and hair left up to 0.55 mm of one person in trials
constexpr double kResidualPerNoise = 2.5;
constexpr double kLikeAPerson = 0.65;     // overlap: mirror images of people keep more, other things less
constexpr double kMirrorGain = 0.7;       // of the residual: sides differ by 1 mm and more in people, noise is 0.2 mm
constexpr double kLeastHoldUnsaidMm = 5;  // of surfaces that do not say how uncertain they are: noise looks like relief
constexpr double kHoldPerResidual = 7;    // a ball resists by 2 to 3 times its residual, faces by 9 and more
constexpr double kRivalRatio = 1.1, kRivalMargin = 0.01;  // losses of the same basin differ by less than a hundredth

std::string Number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Refuses a fit that cannot be trusted; `part` is "head" or "torso".
Status Judge(const Fit& fit, const std::string& part, const Options& options) {
  const auto refuse = [&](const std::string& what) {
    return Fail(ErrorCode::kMeasurementRefused, "the " + part + " of the neutral capture " + what);
  };
  const double least_overlap = options.least_overlap - (fit.residual_mm <= kCloselyMm ? kOverlapForgiven : 0);
  if (fit.pairs.size() < 100 || fit.overlap < least_overlap) {
    return refuse("finds its counterpart in the other capture for only " + Number(100 * fit.overlap, "%.0f %%") +
                  " of its skin (at least " + Number(100 * least_overlap, "%.0f %%") +
                  "): check that both show the same person, and repeat the capture");
  }
  if (fit.visible < kLeastVisible) {
    return refuse("is turned away from the camera or out of the lit field in the other capture (" +
                  Number(100 * fit.visible, "%.0f %%") +
                  " of it can be seen): take the photograph from nearer to the direction of the face");
  }
  const double allowed =
      std::min(options.largest_residual_mm, std::max(kSurelyOneMm, kResidualPerNoise * fit.noise_mm));
  if (fit.residual_mm > allowed) {
    return refuse("lies " + Number(fit.residual_mm, "%.1f mm") + " (root mean square) off its counterpart, more than " +
                  Number(allowed, "%.1f mm") + ": a different person, or stripes out of order in one capture");
  }
  if (fit.rival_loss < kRivalRatio * fit.loss + kRivalMargin) {
    return refuse(
        "fits the other capture in two different ways almost equally well: repeat the capture with the whole "
        "face and chest in the light");
  }
  const double hold = detail::Observability_mm(fit.pairs);
  const double needed = std::max(options.least_observability_mm, kHoldPerResidual * fit.residual_mm);
  if (hold < needed) {
    return refuse("is too smooth to fix its rotation (" + Number(hold, "%.1f mm") +
                  " per rad about its weakest axis, " + Number(needed, "%.1f") +
                  " needed): show nose and brow, or bare the chest");
  }
  return {};
}

/// Refuses a torso that fits its counterpart's mirror image better: one of the photographs was mirrored on its way
/// here.
Status JudgeMirror(const Patch& torso, const Fit& fit, const Capture& capture, const Eigen::Vector3d& shift) {
  if (fit.overlap < kLikeAPerson) return {};  // something else altogether: Judge says so
  Patch mirrored = detail::Mirrored(torso);
  mirrored.fine = mirrored.coarse;  // a ninth of the points is enough to compare residuals, and of the time
  const Fit other = detail::FitTorso(mirrored, capture, shift);
  if (other.overlap < fit.overlap - 0.1 || other.residual_mm > kMirrorGain * fit.residual_mm) return {};
  return Fail(ErrorCode::kMeasurementRefused,
              "the torso fits the other capture's mirror image better (" + Number(other.residual_mm, "%.2f mm") +
                  " instead of " + Number(fit.residual_mm, "%.2f mm") +
                  "): one of the photographs was mirrored; use both as the camera wrote them");
}

/// Stripe orders out of step are seen here as parts that do not fit: a refusal tells what the captures say of
/// themselves.
tl::unexpected<Error> Refused(Error error, const Surface& neutral, const Surface& pose) {
  for (const auto& [which, surface] : {std::pair{"neutral", &neutral}, {"other", &pose}}) {
    for (const std::string& warning : Warnings(*surface)) {
      error.message += std::string("; the ") + which + " capture's reconstruction warns: " + warning;
    }
  }
  return tl::unexpected(std::move(error));
}

FittedPart PartOf(const Fit& fit) {
  FittedPart part;
  part.pose_from_neutral = fit.target_from_patch;
  for (const detail::Pair& pair : fit.pairs) {
    part.point_in_pose.push_back(pair.moved.cast<float>());
    part.residual_mm.push_back(static_cast<float>(pair.ToPlane()));
  }
  return part;
}

}  // namespace

Result<AnalysisReport> Measure(const Surface& neutral, const Surface& pose, const Options& given, HeadFits* fits) {
  if (auto checked = detail::Check(given); !checked) return Fail(checked.error());
  Options options = given;
  if (neutral.uncertainty_mm.empty()) {
    options.least_observability_mm = std::max(options.least_observability_mm, kLeastHoldUnsaidMm);
  }
  const Eigen::Matrix3d subject_from_camera = SubjectFromCamera(options.up_in_camera);
  const auto from = detail::Prepare(neutral, options.spacing_mm, "neutral");
  if (!from) return Fail(from.error());
  const auto to = detail::Prepare(pose, options.spacing_mm, "other");
  if (!to) return Fail(to.error());
  if (to->first.size() < 1000 || to->second.size() < 100) {
    return Fail(ErrorCode::kMeasurementRefused, "the other capture has too few points for a head and a torso");
  }
  const auto parts = detail::Segment(from->first, subject_from_camera, options.regions);
  if (!parts) return Fail(parts.error());

  const Capture capture{detail::Target(to->second), detail::Target(to->first)};
  const Patch torso_patch = detail::MakePatch(from->first, parts->torso);
  const Eigen::Vector3d shift = detail::Middle(to->second) - detail::Middle(from->second);
  const Fit torso = detail::FitTorso(torso_patch, capture, shift);
  if (auto judged = JudgeMirror(torso_patch, torso, capture, shift); !judged) {
    return Refused(judged.error(), neutral, pose);
  }
  if (auto judged = Judge(torso, "torso", options); !judged) return Refused(judged.error(), neutral, pose);
  const Fit head = detail::FitHead(detail::MakePatch(from->first, parts->head), capture, torso.target_from_patch,
                                   parts->neck_in_camera, subject_from_camera);
  if (auto judged = Judge(head, "head", options); !judged) return Refused(judged.error(), neutral, pose);

  const Eigen::Vector3d neck_moved =
      head.target_from_patch * parts->neck_in_camera - torso.target_from_patch * parts->neck_in_camera;
  if (neck_moved.norm() > kLargestNeckMoveMm) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the head came out " + Number(neck_moved.norm(), "%.0f mm") +
                    " away from the torso it sits on: the stripe order of head or torso is wrong in one capture; "
                    "reconstruct both again with a better distance");
  }
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond(torso.target_from_patch.linear().transpose() * head.target_from_patch.linear())
          .normalized()
          .toRotationMatrix();
  const auto sd = detail::Uncertainties(head, torso, subject_from_camera, options);
  if (!sd) return Fail(ErrorCode::kMeasurementRefused, "the skin in common is too small to state an uncertainty");
  if (fits != nullptr) *fits = {PartOf(head), PartOf(torso), parts->neck_in_camera, subject_from_camera};
  Regions used = options.regions;
  if (used.head_px.empty()) used.head_px = detail::HullOf(from->first, parts->head);
  if (used.torso_px.empty()) used.torso_px = detail::HullOf(from->first, parts->torso);
  return detail::Report(head, torso, rotation, subject_from_camera, *sd, used, options);
}

}  // namespace striae::head
