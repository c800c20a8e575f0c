#include "reconstruct/calibrate/board.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/optics.h"
#include "reconstruct/calibrate/detail/board_problem.h"
#include "reconstruct/calibrate/detail/orders.h"
#include "reconstruct/calibrate/detail/pack.h"
#include "reconstruct/calibrate/detail/start.h"
#include "reconstruct/calibrate/photographs.h"
#include "reconstruct/order.h"

namespace striae::reconstruct {
namespace {

using detail::BoardFree;
using detail::BoardProblem;

constexpr std::size_t kFewestCorners = 8, kFewestViews = 5, kFewestInSheet = 30;
constexpr double kSamples = 6000;  ///< on the whole sensor; a plane needs few
constexpr double kLeastDepthShare = 0.04, kLeastTilts_deg = 10;
constexpr double kOffsetTolerance = 0.2;
constexpr double kLargestCorner_px = 6, kLargestSd_stripes = 0.1;
constexpr double kFarthestFromDesign = 5;

tl::unexpected<Error> Refuse(const std::string& why) {
  return Fail(ErrorCode::kBadCalibration, "these photographs of the board cannot calibrate the rig: " + why);
}

/// Photographs at one distance and tilt leave focal length and depth to each other.
Status CheckPoses(const BoardProblem& problem, std::size_t views) {
  std::vector<double> depths;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t v = 0; v < views; ++v) {
    const double* pose = problem.pose(v).values;
    depths.push_back(pose[5]);
    normals.push_back(RotationFromRodrigues({pose[0], pose[1], pose[2]}).col(2));
  }
  const auto [nearest, farthest] = std::minmax_element(depths.begin(), depths.end());
  if (*farthest - *nearest < kLeastDepthShare * *nearest) {
    return Refuse("the board is at one distance in all of them; spread them over the whole working range");
  }
  double tilts_deg = 0;
  for (const auto& a : normals) {
    for (const auto& b : normals) {
      tilts_deg = std::max(tilts_deg, std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi);
    }
  }
  if (tilts_deg < kLeastTilts_deg) return Refuse("the board is tilted alike in all of them; tilt it to all sides");
  return {};
}

/// From the corners alone to everything together. Returns each offset's distance from a whole number.
Result<std::vector<double>> RunStages(BoardProblem& problem, std::size_t views) {
  const auto failed = [] { return Refuse("the fit did not converge"); };
  if (Status posed = problem.FindPoses(); !posed) return Fail(posed.error());
  if (!problem.Solve(BoardFree::kCameraAndPoses, true, 50)) return failed();
  for (std::size_t v = 0; v < views; ++v) {
    if (problem.CornerRms(v) > kLargestCorner_px) {
      return Refuse("the corners of photograph " + std::to_string(v + 1) + " miss a plane by " +
                    std::to_string(problem.CornerRms(v)) + " px; is the board flat, and printed as the options say?");
    }
  }
  if (Status posed = CheckPoses(problem, views); !posed) return Fail(posed.error());
  problem.LearnSigmas();
  if (!problem.Solve(BoardFree::kCameraAndPoses, true, 50)) return failed();
  problem.GuessOffsets();
  if (!problem.Solve(BoardFree::kProjector, true, 50)) return failed();
  problem.LearnSigmas();
  if (!problem.Solve(BoardFree::kAll, true, 50)) return failed();
  const detail::Settled settled = detail::SettleOffsets(problem.offsets());
  problem.offsets() = settled.whole;
  problem.parameters().projector[7] -= settled.fraction;
  for (std::size_t v = 0; v < views; ++v) {
    if (std::abs(settled.distance[v]) > kOffsetTolerance) {
      return Refuse("the stripe count of photograph " + std::to_string(v + 1) + " does not settle (" +
                    std::to_string(settled.distance[v]) + " stripes off)");
    }
  }
  if (!problem.Solve(BoardFree::kAll, false, 50)) return failed();
  problem.JoinSheets();
  for (int round = 0; round < 2; ++round) {
    problem.LearnSigmas();
    if (!problem.Solve(BoardFree::kAll, false, 50)) return failed();
  }
  return settled.distance;
}

Spread SpreadOfDoubles(const std::vector<double>& values) { return SpreadOf({values.begin(), values.end()}); }

void DescribeView(const BoardProblem& problem, const CharucoBoard& board, std::size_t v, BoardViewFit& view) {
  const double* pose = problem.pose(v).values;
  const Eigen::Matrix3d rotation = RotationFromRodrigues({pose[0], pose[1], pose[2]});
  const Eigen::Vector3d middle(board.columns * board.square_mm / 2, board.rows * board.square_mm / 2, 0);
  view.distance_mm = (rotation * middle + Eigen::Vector3d(pose[3], pose[4], pose[5])).z();
  view.tilt_deg = std::acos(std::clamp(std::abs(rotation(2, 2)), 0.0, 1.0)) * 180 / std::numbers::pi;
  view.sd_stripes = SpreadOfDoubles(problem.Differences(v)).sd;
  view.sd_mm = SpreadOfDoubles(problem.DepthDifferences(v)).sd;
  view.corner_rms_px = problem.CornerRms(v);
  view.samples = static_cast<int>(problem.SamplesIn(v));
}

}  // namespace

Result<BoardView> ViewOfBoard(const PhaseResult& phase, const CharucoBoard& board) {
  BoardView view;
  auto corners = detail::FindBoardCorners(phase.background, board);
  if (!corners) return Fail(corners.error());
  view.corners = std::move(*corners);
  if (view.corners.size() < kFewestCorners) {
    return Fail(ErrorCode::kBadCalibration,
                "only " + std::to_string(view.corners.size()) +
                    " corners of the board are seen; show the whole board, sharp, and check "
                    "which board was printed");
  }
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  const int across = std::max(3, static_cast<int>(phase.carrier_period_px / 2));
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(phase.mask.size()) / kSamples)));
  std::map<int, OrderSheet> sheets;
  for (int row = step / 2; row < phase.mask.height(); row += step) {
    for (int col = step / 2; col < phase.mask.width(); col += step) {
      const int region = phase.unwrapped.region(col, row);
      if (region < 0 || !phase.FitsAt(col, row)) continue;
      const int dx = horizontal ? 0 : across, dy = horizontal ? across : 0;
      const auto inside = [&](int x, int y) {
        return phase.mask.Contains(x, y) && phase.unwrapped.region(x, y) == region;
      };
      if (!inside(col - dx, row - dy) || !inside(col + dx, row + dy)) continue;
      sheets[region].samples.push_back({{static_cast<double>(col), static_cast<double>(row)},
                                        static_cast<double>(phase.unwrapped.phase(col, row)) / (2 * std::numbers::pi)});
    }
  }
  for (auto& [region, sheet] : sheets) {
    if (sheet.samples.size() >= kFewestInSheet || region == 0) view.sheets.push_back(std::move(sheet));
  }
  const auto edges = FindGratingEdges(phase, 1);
  if (!edges.empty() && edges.front().low) view.low_edge_order = edges.front().low->order;
  if (!edges.empty() && edges.front().high) view.high_edge_order = edges.front().high->order;
  return view;
}

Result<BoardFit> SolveWithBoard(const std::vector<BoardView>& views, const CharucoBoard& board,
                                const NominalRig& nominal) {
  if (views.size() < kFewestViews) return Refuse("fewer than five; photograph the board at about twelve poses");
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views[v].sheets.empty() || views[v].sheets[0].samples.size() < kFewestInSheet) {
      return Refuse("photograph " + std::to_string(v + 1) + " shows too few stripes on the board");
    }
  }
  const int axis = nominal.direction == StripeDirection::kHorizontal ? 1 : 0;
  BoardProblem problem(views, detail::NominalRigParameters(nominal), axis);
  const auto distances = RunStages(problem, views.size());
  if (!distances) return Fail(distances.error());
  if (const auto far = FarFromDesign(problem.parameters(), problem.nominal(), problem.law(), kFarthestFromDesign);
      !far.empty()) {
    return Refuse("the solution is no such rig (" + far + "); check the board's size and the options");
  }

  BoardFit fit;
  std::vector<detail::SeenEdges> edges;
  for (const BoardView& view : views) edges.push_back({view.low_edge_order, view.high_edge_order});
  const auto gauge = GaugeFromEdges(edges, problem.offsets(), nominal.stripes);
  fit.order_is_absolute = gauge.has_value();
  problem.parameters().projector[7] += gauge.value_or(0);
  for (double& offset : problem.offsets()) offset += gauge.value_or(0);
  fit.calibration = PackCalibration(problem.parameters(), problem.law(), nominal);
  if (gauge) fit.calibration.stripes = nominal.stripes;
  std::vector<float> all;
  double corners = 0, squares = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    BoardViewFit view{static_cast<int>(std::lround(problem.offsets()[v])), (*distances)[v]};
    DescribeView(problem, board, v, view);
    view.corners = static_cast<int>(views[v].corners.size());
    if (view.sd_stripes > kLargestSd_stripes) {
      return Refuse("the stripes of photograph " + std::to_string(v + 1) + " lie on no plane (" +
                    std::to_string(view.sd_stripes) + " stripes sd)");
    }
    for (const double difference : problem.DepthDifferences(v)) all.push_back(static_cast<float>(difference));
    corners += view.corners;
    squares += view.corners * view.corner_rms_px * view.corner_rms_px;
    const double near_mm = view.distance_mm, far_mm = view.distance_mm;
    fit.calibration.near_mm = v == 0 ? near_mm : std::min(fit.calibration.near_mm, near_mm);
    fit.calibration.far_mm = v == 0 ? far_mm : std::max(fit.calibration.far_mm, far_mm);
    fit.views.push_back(view);
  }
  const Spread spread = SpreadOf(std::move(all));
  fit.sd_mm = spread.sd;
  fit.robust_sd_mm = spread.robust_sd;
  fit.corner_rms_px = std::sqrt(squares / corners);
  fit.calibration.quality = Calibration::Quality{fit.sd_mm, static_cast<int>(views.size())};
  const Eigen::MatrixXd covariance = problem.Covariance();
  ReportParameters(covariance, problem.parameters(), problem.law(), fit.parameters, fit.correlations);
  if (covariance.trace() > 0) {
    fit.calibration.uncertainty = PackUncertainty(covariance, problem.parameters(), problem.law());
  }
  return fit;
}

}  // namespace striae::reconstruct
