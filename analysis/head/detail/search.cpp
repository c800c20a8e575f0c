#include "analysis/head/detail/search.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace striae::head::detail {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::array<Stage, 2> kCoarse{{{60, 35, 6}, {30, 35, 10}}};
// The last gate is narrow: where normals still differ by more than 20 degrees, the Fourier window rang (eyes, lips, the
// field's rim), and leaving that out halved the error through photographs.
constexpr std::array<Stage, 3> kFine{{{30, 35, 15}, {12, 35, 15}, {6, 20, 30, true}}};
constexpr double kCoarseGateMm = 15;  // two and a half coarse spacings
constexpr double kFineGateMm = 6;
constexpr std::size_t kFinalists = 3;
constexpr double kRivalRad = 5 * kDegree;

/// A turn about a point.
Eigen::Isometry3d TurnAbout(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& pivot) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = rotation;
  turn.translation() = pivot - rotation * pivot;
  return turn;
}

double AngleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// All starts on the coarse points, the best few distinct ones on the fine points, the best of these.
Fit Search(const Patch& patch, const Capture& capture, const std::vector<Eigen::Isometry3d>& starts) {
  std::vector<Fit> rough;
  rough.reserve(starts.size());
  for (const Eigen::Isometry3d& start : starts) {
    rough.push_back(
        capture.coarse.Judge(patch.coarse, capture.coarse.Align(patch.coarse, start, kCoarse), kCoarseGateMm));
  }
  std::stable_sort(rough.begin(), rough.end(), [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  std::vector<Fit> finalists;
  for (const Fit& candidate : rough) {
    const bool known = std::any_of(finalists.begin(), finalists.end(), [&](const Fit& fit) {
      return AngleBetween(fit.target_from_patch, candidate.target_from_patch) < 4 * kDegree;
    });
    if (!known) finalists.push_back(candidate);
    if (finalists.size() == kFinalists) break;
  }
  std::vector<Fit> refined;
  for (const Fit& finalist : finalists) {
    // Clearly worse on the coarse points: a wrong basin, not worth the fine points' time.
    if (finalist.loss > 1.5 * finalists.front().loss + 0.02) continue;
    Fit fit =
        capture.fine.Judge(patch.fine, capture.fine.Align(patch.fine, finalist.target_from_patch, kFine), kFineGateMm);
    refined.push_back(std::move(fit));
  }
  std::stable_sort(refined.begin(), refined.end(), [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  if (refined.empty()) return {};
  Fit best = std::move(refined.front());
  for (std::size_t i = 1; i < refined.size(); ++i) {
    if (AngleBetween(best.target_from_patch, refined[i].target_from_patch) > kRivalRad) {
      best.rival_loss = std::min(best.rival_loss, refined[i].loss);
    }
  }
  return best;
}

}  // namespace

Fit FitTorso(const Patch& torso, const Capture& capture, const Eigen::Vector3d& shift) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : torso.coarse.point) middle += p.cast<double>();
  middle /= static_cast<double>(std::max<std::size_t>(1, torso.coarse.size()));
  std::vector<Eigen::Isometry3d> starts;
  for (const Eigen::Vector3d& move : {Eigen::Vector3d(0, 0, 0), shift}) {
    for (const double turn : {0, -25, 25}) {
      for (const double lean : {0, -15, 15}) {
        const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(lean * kDegree, Eigen::Vector3d::UnitZ()) *
                                          Eigen::AngleAxisd(turn * kDegree, Eigen::Vector3d::UnitY()))
                                             .toRotationMatrix();
        starts.push_back(Eigen::Translation3d(move) * TurnAbout(rotation, middle));
      }
    }
  }
  return Search(torso, capture, starts);
}

Fit FitHead(const Patch& head, const Capture& capture, const Eigen::Isometry3d& torso_motion,
            const Eigen::Vector3d& neck, const Eigen::Matrix3d& subject_from_camera) {
  std::vector<Eigen::Isometry3d> starts;
  for (const double turn : {0, -30, 30, -60, 60}) {
    for (const double nod : {0, -30, 30}) {
      for (const double tilt : {0, -30, 30}) {
        const Eigen::Matrix3d in_subject = (Eigen::AngleAxisd(nod * kDegree, Eigen::Vector3d::UnitZ()) *
                                            Eigen::AngleAxisd(tilt * kDegree, Eigen::Vector3d::UnitX()) *
                                            Eigen::AngleAxisd(turn * kDegree, Eigen::Vector3d::UnitY()))
                                               .toRotationMatrix();
        const Eigen::Matrix3d rotation = subject_from_camera.transpose() * in_subject * subject_from_camera;
        starts.push_back(torso_motion * TurnAbout(rotation, neck));
      }
    }
  }
  return Search(head, capture, starts);
}

}  // namespace striae::head::detail
