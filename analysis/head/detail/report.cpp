#include "analysis/head/detail/report.h"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "analysis/head/angles.h"
#include "analysis/head/detail/uncertainty.h"
#include "analysis/head/twstrs.h"

namespace striae::head::detail {
namespace {

constexpr double kCellMm = 30;        // correlation length of the Fourier stage's noise at 2 m, with a margin
constexpr double kSingularTilt = 80;  // deg
// A part that changed its shape (a breath, an expression) leaves residuals that turn it all together. Share of the turn
// that would leave such residuals; through 59 pairs of photographs the error was 0.06 (heads) and 0.05 to 0.2 of it
// (torsos), what the bootstrap sees included.
constexpr double kHeadShare = 0.04, kTorsoShare = 0.12;

const std::array<Measurement, 4> kNames{{
    {"rotation", {"99STRIAE", "HT-ROT", "Head rotation relative to torso, positive to subject's left"}},
    {"flexion", {"99STRIAE", "HT-FLEX", "Head flexion relative to torso, positive chin to chest"}},
    {"tilt", {"99STRIAE", "HT-TILT", "Head lateral tilt relative to torso, positive to subject's right"}},
    {"total_angle", {"99STRIAE", "HT-TOTAL", "Total angle of head relative to torso"}},
}};
constexpr const char* kSequence = "Z-X-Y intrinsic, ISB axes (X forward, Y up, Z right): extension, tilt, rotation";

nlohmann::json Rows(const Eigen::Matrix3d& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({matrix(i, 0), matrix(i, 1), matrix(i, 2)});
  return rows;
}

/// The four angles with their uncertainties; those of the sequence are flagged where it is singular.
std::vector<Measurement> Measurements(const AngleArray& angles, const AngleArray& sd) {
  const bool singular = std::abs(angles[2]) > kSingularTilt;
  std::vector<Measurement> list;
  for (std::size_t k = 0; k < 4; ++k) {
    Measurement m = kNames[k];
    m.value = angles[k];
    m.unit = "deg";
    m.uncertainty = sd[k];
    if (singular && k < 3) {
      m.status = Measurement::Status::kFlagged;
      m.reason =
          "beyond a tilt of 80 deg rotation and flexion cannot be told apart: use rotation_matrix and total_angle";
    }
    list.push_back(std::move(m));
  }
  return list;
}

AngleArray AnglesOf(const Eigen::Matrix3d& rotation_in_subject) {
  const HeadAngles a = Decompose(rotation_in_subject);
  return {a.rotation.deg(), a.flexion.deg(), a.tilt.deg(), a.total.deg()};
}

nlohmann::json Part(const Fit& fit) {
  return {{"residual_mm", fit.residual_mm},
          {"overlap", fit.overlap},
          {"visible", fit.visible},
          {"agreement", fit.agreement},
          {"loss", fit.loss},
          {"rival_loss", fit.rival_loss},
          {"observability_mm", Observability_mm(fit.pairs)},
          {"points", fit.pairs.size()}};
}

/// Standard uncertainty about each axis that a changed shape adds.
double ShapeDeg(const Fit& fit, double share) {
  const double hold_mm = Observability_mm(fit.pairs);
  return hold_mm > 0 ? share * Angle::Radians(fit.residual_mm / hold_mm).deg() : 0;
}

nlohmann::json RegionsJson(const Regions& used, const Regions& drawn) {
  nlohmann::json json = nlohmann::json::parse(ToJsonText(used));
  json["head_source"] = drawn.head_px.empty() ? "found" : "drawn";
  json["torso_source"] = drawn.torso_px.empty() ? "found" : "drawn";
  return json;
}

}  // namespace

std::optional<AngleUncertainty> Uncertainties(const Fit& head, const Fit& torso,
                                              const Eigen::Matrix3d& subject_from_camera, const Options& options) {
  const auto heads = BootstrapRotations(head.pairs, kCellMm, options.resamples, options.seed);
  const auto torsos = BootstrapRotations(torso.pairs, kCellMm, options.resamples, options.seed + 1);
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
  AngleUncertainty sd;
  AngleArray of_axes{};
  const double axes_sd_rad = Angle::Degrees(options.axes_sd_deg).rad();
  for (int axis = 0; axis < 3; ++axis) {
    const AngleArray sample = angles_with(none, none, axes_sd_rad * Eigen::Vector3d::Unit(axis));
    for (std::size_t k = 0; k < 4; ++k) of_axes[k] += difference(sample, k) * difference(sample, k);
  }
  const double alike = std::hypot(options.floor_sd_deg, ShapeDeg(head, kHeadShare), ShapeDeg(torso, kTorsoShare));
  for (std::size_t k = 0; k < 4; ++k) {
    variance[k] += alike * alike;
    sd.registration[k] = std::sqrt(variance[k]);
    sd.whole[k] = std::sqrt(variance[k] + of_axes[k]);
    if (!std::isfinite(sd.whole[k])) return std::nullopt;
  }
  return sd;
}

AnalysisReport Report(const Fit& head, const Fit& torso, const Eigen::Matrix3d& rotation,
                      const Eigen::Matrix3d& subject_from_camera, const AngleUncertainty& sd, const Regions& used,
                      const Options& options) {
  AnalysisReport report;
  report.analysis = "head";
  report.version = "2";
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
  report.measurements = Measurements(angles, sd.whole);
  nlohmann::json words = nlohmann::json::object(), registration = words, bands = words;
  for (std::size_t k = 0; k < 4; ++k) {
    const Measurement& m = report.measurements[k];
    words[m.name] = InWords(m.name, m.value);
    registration[m.name] = sd.registration[k];
    if (const auto band = TwstrsBand(m.name, m.value); band && m.status == Measurement::Status::kOk) {
      bands[m.name] = {{"score", band->score}, {"words", band->words}};
    }
  }
  report.details = {{"rotation_matrix", Rows(rotation)},
                    {"axes_source", "camera"},
                    {"sequence", kSequence},
                    {"words", words},
                    {"registration_uncertainty", registration},
                    {"twstrs_bands", bands},
                    {"regions", RegionsJson(used, options.regions)},
                    {"head", Part(head)},
                    {"torso", Part(torso)}};
  report.details["residual_mm"] = {{"head", head.residual_mm}, {"torso", torso.residual_mm}};
  report.details["overlap"] = {{"head", head.overlap}, {"torso", torso.overlap}};
  return report;
}

AnalysisReport AbsoluteReport(const Fit& head, const Fit& torso, const Eigen::Matrix3d& rotation_in_subject,
                              bool landmarks_given, const Options& options) {
  AnalysisReport report;
  report.analysis = "head";
  report.version = "2";
  report.provenance.version = StriaeVersion();
  report.provenance.parameters = {{"spacing_mm", options.spacing_mm},
                                  {"symmetry_sd_deg", options.symmetry_sd_deg},
                                  {"profile_sd_deg", options.profile_sd_deg}};
  const AngleArray angles = AnglesOf(rotation_in_subject);
  const double side = options.symmetry_sd_deg, profile = options.profile_sd_deg;
  // A profile that slopes otherwise than was taken leans the head's up axis; turned or tilted, it leans to the side.
  const double turned = std::sin(Angle::Degrees(angles[0]).rad()), tilted = std::sin(Angle::Degrees(angles[2]).rad());
  // The total angle turns about whatever axis the pose has: the worst of all holds for it.
  report.measurements = Measurements(angles, {std::hypot(side, profile * tilted), profile,
                                              std::hypot(side, profile * turned), std::hypot(side, profile)});
  nlohmann::json words = nlohmann::json::object();
  for (const Measurement& m : report.measurements) words[m.name] = InWords(m.name, m.value);
  report.details = {{"rotation_in_subject", Rows(rotation_in_subject)},
                    {"axes_source", "anatomical"},
                    {"landmarks_source", landmarks_given ? "given" : "found"},
                    {"sequence", kSequence},
                    {"words", words},
                    {"symmetry_residual_mm", {{"head", head.residual_mm}, {"torso", torso.residual_mm}}},
                    {"overlap", {{"head", head.overlap}, {"torso", torso.overlap}}}};
  return report;
}

}  // namespace striae::head::detail
