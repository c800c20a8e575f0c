#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlopt.hpp>

#include "reconstruct/calibrate/detail/orders.h"
#include "reconstruct/calibrate/detail/stages.h"

namespace striae::reconstruct::detail {
namespace {

constexpr std::size_t kSamples = 250;  ///< of each photograph: a search without derivatives asks for them often
constexpr double kUnitOfSigma = 0.2;
constexpr int kLastEvaluations = 24000;
constexpr unsigned long kSeed = 20261122;
constexpr double kTolerance = 1e-6;   ///< relative, of the sd
constexpr double kHopeless_mm = 1e6;  ///< for parameters that no surface can have

/// Which parameters a search moves, each in units of its prior's sigma (pose: mm and hundredths of a radian), so that
/// the first directions are sensible.
struct Place {
  Block block;
  int index;
  double unit;
};

std::vector<Place> Places(const RigFit& fit, Free free) {
  std::vector<Place> places;
  for (int i = 0; i < 6; ++i) places.push_back({kPoseBlock, i, i < 3 ? 0.01 : 2.0});
  if (free == Free::kPose) return places;
  for (const Prior& prior : Priors(fit.nominal(), fit.law(), true)) {
    if (prior.block == kCameraBlock && (free != Free::kAll || fit.misfit_is_systematic())) continue;
    if (prior.block == kProjectorBlock && prior.index == 7) continue;  // has a closed form
    // The angular law does not know the projector's place along the stripes.
    if (fit.law().kind == ProjectorModel::Kind::kAngular && prior.block == kProjectorBlock &&
        prior.index == 1 - fit.law().axis) {
      continue;
    }
    places.push_back({prior.block, prior.index, kUnitOfSigma * prior.sigma});
  }
  return places;
}

class Search {
 public:
  Search(RigFit& fit, Free free, bool each_its_own, const SolveOptions& options)
      : fit_(fit), places_(Places(fit, free)), each_its_own_(each_its_own), options_(options) {}

  /// False when NLopt failed or nothing was found. The fit has the best parameters.
  bool Run(int evaluations, double share_before, double share_after) {
    evaluations_ = evaluations;
    share_before_ = share_before;
    share_after_ = share_after;
    start_ = fit_.parameters();
    best_sd_ = kHopeless_mm;
    best_ = start_;
    try {
      nlopt::srand(kSeed);  // PRAXIS takes random steps
      nlopt::opt search(nlopt::LN_PRAXIS, static_cast<unsigned>(places_.size()));
      search.set_min_objective([](const std::vector<double>& x, std::vector<double>&,
                                  void* self) { return static_cast<Search*>(self)->Objective(x); },
                               this);
      search.set_ftol_rel(kTolerance);
      search.set_maxeval(evaluations);
      search.set_initial_step(1.0);
      std::vector<double> x(places_.size(), 0.0);
      double sd = 0;
      search.optimize(x, sd);
    } catch (const std::exception&) {  // rounding limits end PRAXIS, too: what counts is what it found
    }
    fit_.parameters() = best_;
    return best_sd_ < kHopeless_mm;
  }

  /// Puts what the differences have in common into the offsets (each photograph's, or the central order for all).
  void AdoptCommon() {
    const auto common = Sum(fit_.parameters()).common;
    if (each_its_own_) {
      for (std::size_t v = 0; v < common.size(); ++v) fit_.offsets()[v] -= common[v];
    } else {
      fit_.parameters().projector[7] += common.front();
    }
  }

 private:
  struct Sums {
    double sd_mm = 0, count = 0;
    std::vector<double> common;  ///< stripes; of each photograph, or of all
  };
  /// The sd in mm after the whole stripes' (or the central order's) best value, which has a closed form.
  Sums Sum(const RigParameters& at) const {
    Sums sums;
    double squares = 0, cross = 0, weight = 0;
    for (std::size_t v = 0; v < fit_.offsets().size(); ++v) {
      for (const auto& difference : fit_.DepthDifferences(at, v)) {
        squares += difference.mm * difference.mm;
        cross += difference.mm * difference.mm_per_stripe;
        weight += difference.mm_per_stripe * difference.mm_per_stripe;
        sums.count += 1;
      }
      if (!each_its_own_ && v + 1 < fit_.offsets().size()) continue;
      sums.common.push_back(weight > 0 ? cross / weight : 0);
      squares -= weight > 0 ? cross * cross / weight : 0;
      cross = weight = 0;
    }
    sums.sd_mm = std::sqrt(std::max(0.0, squares) / sums.count);
    return sums;
  }

  double Objective(const std::vector<double>& x) {
    RigParameters trial = start_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      BlockOf(trial, places_[i].block)[places_[i].index] += places_[i].unit * x[i];
    }
    const Sums sums = Sum(trial);
    // The weak beliefs, as least squares weighs them when its sigma is the sd that is found: without them the
    // projector's place along the stripes runs away (178 mm), which hardly changes any depth.
    double beliefs = 0;
    for (const Place& place : places_) {
      if (place.block == kPoseBlock) continue;
      const double off = BlockOf(trial, place.block)[place.index] - BlockOf(fit_.nominal(), place.block)[place.index];
      beliefs += std::pow(kUnitOfSigma * off / place.unit, 2);
    }
    const double sd = sums.sd_mm * std::sqrt(1 + beliefs / sums.count);
    if (++asked_ % 100 == 0 && options_.progress) {
      options_.progress(share_before_ + (share_after_ - share_before_) * asked_ / evaluations_,
                        "Powell's method, sd " + std::to_string(best_sd_) + " mm");
    }
    if (!std::isfinite(sd)) return kHopeless_mm;
    if (sd < best_sd_) {
      best_sd_ = sd;
      best_ = trial;
    }
    return sd;
  }

  RigFit& fit_;
  std::vector<Place> places_;
  bool each_its_own_;
  const SolveOptions& options_;
  RigParameters start_, best_;
  double best_sd_ = kHopeless_mm;
  double share_before_ = 0, share_after_ = 1;
  int asked_ = 0, evaluations_ = 1;
};

}  // namespace

Result<Solved> SolveByPowell(RigFit& fit, const SolveOptions& options) {
  const auto failed = [] {
    return Fail(ErrorCode::kBadCalibration,
                "these photographs cannot calibrate the rig: Powell's method found no surface; check the mesh's unit "
                "and axes, or leave out --optimizer powell");
  };
  fit.SelectSamples(kSamples);
  fit.GuessOffsets();
  constexpr struct {
    Free free;
    int evaluations;
    double share;
  } kStages[] = {{Free::kPose, 1000, 0.03}, {Free::kPoseSlideProjector, 4000, 0.1}, {Free::kAll, 16000, 0.5}};
  double share = 0;
  for (const auto& stage : kStages) {
    Search search(fit, stage.free, true, options);
    if (!search.Run(stage.evaluations, share, stage.share)) return failed();
    search.AdoptCommon();
    fit.SelectSamples(kSamples);
    share = stage.share;
  }
  Solved solved;
  solved.sd_free = fit.Spread();
  const Settled settled = SettleOffsets(fit.offsets());
  solved.distances = settled.distance;
  fit.offsets() = settled.whole;
  fit.parameters().projector[7] -= settled.fraction;
  if (!RefineByPowell(fit, options)) return failed();
  solved.sd_fixed = fit.Spread();
  // The search with open whole stripes ends well before its minimum; whether they are right shows when they are fixed.
  for (std::size_t v = 0; v < solved.distances.size(); ++v) {
    const std::vector<double> d = fit.Differences(v);
    solved.distances[v] =
        std::accumulate(d.begin(), d.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, d.size()));
  }
  return solved;
}

bool RefineByPowell(RigFit& fit, const SolveOptions& options) {
  fit.SelectSamples(kSamples);
  Search search(fit, Free::kAll, false, options);
  if (!search.Run(kLastEvaluations, 0.5, 1)) return false;
  search.AdoptCommon();
  return true;
}

}  // namespace striae::reconstruct::detail
