#include "analysis/head/measure.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "analysis/head/angles.h"
#include "analysis/head/detail/search.h"
#include "analysis/head/detail/uncertainty.h"

namespace striae::head {
namespace {

using detail::Capture;
using detail::Cloud;
using detail::Fit;
using detail::Patch;

constexpr double kCellMm = 30;              // correlation length of the Fourier stage's noise at 2 m, with a margin
constexpr double kLargestNeckMoveMm = 110;  // protraction or side shift of a neck; one stripe in depth is 135 mm
constexpr double kLeastVisible = 0.4;
constexpr double kSingularTilt = 80;  // deg

using AngleArray = std::array<double, 4>;  // rotation, flexion, tilt, total; deg

AngleArray AnglesOf(const Eigen::Matrix3d& rotation_in_subject) {
  const HeadAngles a = Decompose(rotation_in_subject);
  return {a.rotation.deg(), a.flexion.deg(), a.tilt.deg(), a.total.deg()};
}

Status Check(const Options& options) {
  const Eigen::Vector3d up = options.up_in_camera;
  if (!up.allFinite() || up.norm() < 0.5 || std::abs(up.normalized().z()) > 0.86) {
    return Fail(ErrorCode::kUsage, "the subject's up must be a unit vector across the optical axis");
  }
  if (!(options.spacing_mm >= 0.5 && options.spacing_mm <= 6) || options.resamples < 20 || options.resamples > 100000) {
    return Fail(ErrorCode::kUsage, "spacing must be 0.5 to 6 mm, and resamples 20 to 100000");
  }
  return {};
}

/// Fine and coarse points with normals; normals reach three spacings, as far as skin is flat.
Result<std::pair<Cloud, Cloud>> Prepare(const Surface& surface, double spacing_mm, const char* which) {
  const std::string where = std::string("preparing the ") + which + " capture";
  auto fine = detail::WithNormals(detail::Thin(surface, spacing_mm), std::max(5.0, 3 * spacing_mm));
  if (!fine) return Fail(fine.error(), where);
  auto coarse = detail::WithNormals(detail::Thin(surface, 3 * spacing_mm), 8 * spacing_mm);
  if (!coarse) return Fail(coarse.error(), where);
  return std::pair{std::move(*fine), std::move(*coarse)};
}

Eigen::Vector3d Middle(const Cloud& cloud) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : cloud.point) middle += p.cast<double>();
  return middle / static_cast<double>(std::max<std::size_t>(1, cloud.size()));
}

/// Every fourth point or so: a coarse patch from the fine one keeps both on the same skin.
Patch MakePatch(const Cloud& fine, const std::vector<std::uint32_t>& indices) {
  Patch patch;
  patch.fine = detail::Select(fine, indices);
  std::vector<std::uint32_t> few;
  for (std::size_t i = 0; i < indices.size(); i += 9) few.push_back(indices[i]);
  patch.coarse = detail::Select(fine, few);
  return patch;
}

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
  if (fit.pairs.size() < 100 || fit.overlap < options.least_overlap) {
    return refuse("finds its counterpart in the other capture for only " + Number(100 * fit.overlap, "%.0f %%") +
                  " of its skin (at least " + Number(100 * options.least_overlap, "%.0f %%") +
                  "): check that both show the same person, and repeat the capture");
  }
  if (fit.visible < kLeastVisible) {
    return refuse("is turned away from the camera or out of the lit field in the other capture (" +
                  Number(100 * fit.visible, "%.0f %%") +
                  " of it can be seen): take the photograph from nearer to the direction of the face");
  }
  if (fit.residual_mm > options.largest_residual_mm) {
    return refuse("lies " + Number(fit.residual_mm, "%.1f mm") + " (root mean square) off its counterpart, more than " +
                  Number(options.largest_residual_mm, "%.1f mm") +
                  ": a different person, or stripes out of order in one capture");
  }
  const double hold = detail::Observability_mm(fit.pairs);
  if (hold < options.least_observability_mm) {
    return refuse("is too smooth to fix its rotation (" + Number(hold, "%.1f mm") +
                  " per rad about its weakest axis, " + Number(options.least_observability_mm, "%.1f") +
                  " needed): show nose and brow, or bare the chest");
  }
  return {};
}

/// Standard uncertainties of the four angles: resampled registrations, their floor, and the axes' own error.
std::optional<AngleArray> Uncertainties(const Fit& head, const Fit& torso, const Eigen::Matrix3d& subject_from_camera,
                                        const Options& options) {
  const auto heads = detail::BootstrapRotations(head.pairs, kCellMm, options.resamples, options.seed);
  const auto torsos = detail::BootstrapRotations(torso.pairs, kCellMm, options.resamples, options.seed + 1);
  if (heads.size() < 2 || heads.size() != torsos.size()) return std::nullopt;
  const auto turn = [](const Eigen::Vector3d& v) {
    return Eigen::AngleAxisd(v.norm(), v.norm() > 0 ? Eigen::Vector3d(v.normalized()) : Eigen::Vector3d::UnitX())
        .toRotationMatrix();
  };
  const auto angles_with = [&](const Eigen::Vector3d& of_head, const Eigen::Vector3d& of_torso,
                               const Eigen::Vector3d& of_axes) {
    const Eigen::Matrix3d r = (turn(of_torso) * torso.target_from_patch.linear()).transpose() * turn(of_head) *
                              head.target_from_patch.linear();
    const Eigen::Matrix3d axes = turn(of_axes) * subject_from_camera;
    return AnglesOf(axes * r * axes.transpose());
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const AngleArray best = angles_with(none, none, none);
  const auto difference = [&](const AngleArray& other, std::size_t k) {
    return std::remainder(other[k] - best[k], 360.0);
  };
  AngleArray variance{};
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const AngleArray sample = angles_with(heads[i], torsos[i], none);
    for (std::size_t k = 0; k < 4; ++k) {
      variance[k] += difference(sample, k) * difference(sample, k) / static_cast<double>(heads.size());
    }
  }
  const double axes_sd_rad = Angle::Degrees(options.axes_sd_deg).rad();
  for (int axis = 0; axis < 3; ++axis) {
    const AngleArray sample = angles_with(none, none, axes_sd_rad * Eigen::Vector3d::Unit(axis));
    for (std::size_t k = 0; k < 4; ++k) variance[k] += difference(sample, k) * difference(sample, k);
  }
  AngleArray sd{};
  for (std::size_t k = 0; k < 4; ++k) {
    sd[k] = std::sqrt(variance[k] + options.floor_sd_deg * options.floor_sd_deg);
    if (!std::isfinite(sd[k])) return std::nullopt;
  }
  return sd;
}

nlohmann::json Part(const Fit& fit) {
  return {{"residual_mm", fit.residual_mm},
          {"overlap", fit.overlap},
          {"visible", fit.visible},
          {"observability_mm", detail::Observability_mm(fit.pairs)},
          {"points", fit.pairs.size()}};
}

AnalysisReport Report(const Fit& head, const Fit& torso, const Eigen::Matrix3d& rotation,
                      const Eigen::Matrix3d& subject_from_camera, const AngleArray& sd, const Options& options) {
  const std::array<Measurement, 4> names{{
      {"rotation", {"99STRIAE", "HT-ROT", "Head rotation relative to torso, positive to subject's left"}},
      {"flexion", {"99STRIAE", "HT-FLEX", "Head flexion relative to torso, positive chin to chest"}},
      {"tilt", {"99STRIAE", "HT-TILT", "Head lateral tilt relative to torso, positive to subject's right"}},
      {"total_angle", {"99STRIAE", "HT-TOTAL", "Total angle of head relative to torso"}},
  }};
  AnalysisReport report;
  report.analysis = "head";
  report.version = "1";
  report.provenance.version = StriaeVersion();
  report.provenance.parameters = {{"spacing_mm", options.spacing_mm},
                                  {"least_overlap", options.least_overlap},
                                  {"axes_sd_deg", options.axes_sd_deg},
                                  {"floor_sd_deg", options.floor_sd_deg},
                                  {"resamples", options.resamples},
                                  {"seed", options.seed},
                                  {"cell_mm", kCellMm},
                                  {"largest_residual_mm", options.largest_residual_mm}};
  const AngleArray angles = AnglesOf(subject_from_camera * rotation * subject_from_camera.transpose());
  const bool singular = std::abs(angles[2]) > kSingularTilt;
  nlohmann::json words = nlohmann::json::object();
  for (std::size_t k = 0; k < 4; ++k) {
    Measurement m = names[k];
    m.value = angles[k];
    m.unit = "deg";
    m.uncertainty = sd[k];
    if (singular && k < 3) {
      m.status = Measurement::Status::kFlagged;
      m.reason =
          "beyond a tilt of 80 deg rotation and flexion cannot be told apart: use rotation_matrix and total_angle";
    }
    words[m.name] = InWords(m.name, m.value);
    report.measurements.push_back(std::move(m));
  }
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({rotation(i, 0), rotation(i, 1), rotation(i, 2)});
  report.details = {{"rotation_matrix", rows},
                    {"axes_source", "camera"},
                    {"sequence", "Z-X-Y intrinsic, ISB axes (X forward, Y up, Z right): extension, tilt, rotation"},
                    {"words", words},
                    {"head", Part(head)},
                    {"torso", Part(torso)}};
  report.details["residual_mm"] = {{"head", head.residual_mm}, {"torso", torso.residual_mm}};
  report.details["overlap"] = {{"head", head.overlap}, {"torso", torso.overlap}};
  return report;
}

}  // namespace

Result<AnalysisReport> Measure(const Surface& neutral, const Surface& pose, const Options& options) {
  if (auto checked = Check(options); !checked) return Fail(checked.error());
  const Eigen::Matrix3d subject_from_camera = SubjectFromCamera(options.up_in_camera);
  const auto from = Prepare(neutral, options.spacing_mm, "neutral");
  if (!from) return Fail(from.error());
  const auto to = Prepare(pose, options.spacing_mm, "other");
  if (!to) return Fail(to.error());
  if (to->first.size() < 1000 || to->second.size() < 100) {
    return Fail(ErrorCode::kMeasurementRefused, "the other capture has too few points for a head and a torso");
  }
  const auto parts = detail::Segment(from->first, subject_from_camera);
  if (!parts) return Fail(parts.error());

  const Capture capture{detail::Target(to->second), detail::Target(to->first)};
  const Fit torso =
      detail::FitTorso(MakePatch(from->first, parts->torso), capture, Middle(to->second) - Middle(from->second));
  if (auto judged = Judge(torso, "torso", options); !judged) return Fail(judged.error());
  const Fit head = detail::FitHead(MakePatch(from->first, parts->head), capture, torso.target_from_patch,
                                   parts->neck_in_camera, subject_from_camera);
  if (auto judged = Judge(head, "head", options); !judged) return Fail(judged.error());

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
  const auto sd = Uncertainties(head, torso, subject_from_camera, options);
  if (!sd) return Fail(ErrorCode::kMeasurementRefused, "the skin in common is too small to state an uncertainty");
  return Report(head, torso, rotation, subject_from_camera, *sd, options);
}

}  // namespace striae::head
