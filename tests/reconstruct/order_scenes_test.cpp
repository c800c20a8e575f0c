// "Wrong by a whole stripe without a warning" must never happen: tempting scenes, each region judged by the geometry.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>

#include <gmock/gmock.h>

#include "core/optics.h"
#include "reconstruct/order.h"
#include "tests/reconstruct/scenes_kinds.h"

namespace striae::reconstruct {
namespace {

using striae::testing::MakeOrderScene;
using striae::testing::OrderScene;
using striae::testing::OrderSceneKinds;

struct Judged {
  RegionOrder order;
  std::size_t points = 0;
  int wrong_by = 0;       ///< whole stripes, of most of its pixels
  double consistent = 0;  ///< share of its pixels with that whole number
  double wrong = 0;       ///< share of its pixels that the order found is wrong for
  [[nodiscard]] bool silent() const { return order.warning.empty() && order.source != OrderSource::kNone; }
};

struct Tally {
  int scenes = 0, regions = 0, right_silent = 0, right_warned = 0, wrong_warned = 0, none = 0, wrong_silent = 0;
  int largest_silent = 0;  ///< scenes whose largest region is right without a warning
};

std::vector<Judged> Judge(const OrderScene& scene, const PhaseResult& phase, const std::vector<RegionOrder>& orders) {
  constexpr int kStep = 2;
  const ImageF depth = DepthOf(scene.scene);
  const StripeOptics optics(scene.scene.rig);
  std::vector<std::vector<int>> offsets(orders.size());
  for (int row = 0; row < depth.height(); row += kStep) {
    for (int col = 0; col < depth.width(); col += kStep) {
      const int region = phase.unwrapped.region(col, row);
      if (region < 0 || !std::isfinite(depth(col, row))) continue;
      const auto order = optics.OrderAt(
          depth(col, row) * RayOf(scene.scene.rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (order) {
        offsets[static_cast<std::size_t>(region)].push_back(
            static_cast<int>(std::lround(*order - phase.unwrapped.phase(col, row) / (2 * std::numbers::pi))));
      }
    }
  }
  std::vector<Judged> judged;
  for (std::size_t r = 0; r < orders.size(); ++r) {
    if (offsets[r].empty()) continue;
    auto& of = offsets[r];
    std::nth_element(of.begin(), of.begin() + static_cast<long>(of.size() / 2), of.end());
    const int truth = of[of.size() / 2];
    const auto same = std::count(of.begin(), of.end(), truth);
    judged.push_back(
        {orders[r], of.size() * kStep * kStep, orders[r].offset - truth,
         static_cast<double>(same) / static_cast<double>(of.size()),
         1 - static_cast<double>(std::count(of.begin(), of.end(), orders[r].offset)) / static_cast<double>(of.size())});
  }
  return judged;
}

void Print(const OrderScene& scene, std::uint32_t seed, const Judged& j) {
  const char* verdict = j.order.source == OrderSource::kNone ? "left out"
                        : j.wrong_by == 0                    ? (j.silent() ? "right" : "right, warned")
                                                             : (j.silent() ? "WRONG" : "wrong, warned");
  std::cout << std::left << std::setw(18) << scene.kind << std::right << std::setw(4) << seed << std::setw(9)
            << j.points << "  " << std::left << std::setw(13) << ToString(j.order.source) << std::right << std::fixed
            << std::setprecision(2) << std::setw(5) << j.order.margin << std::setw(5) << j.wrong_by << std::setw(6)
            << j.consistent << "  " << verdict << "\n";
}

/// Share of the points that may be wrong without a warning: the seam between two parts is known to a sixth of a stripe,
/// which along an arm across a body comes to a quarter of a percent. Known limits: plates level with one another a
/// whole stripe apart have neither a dark outline nor a bent order, and slivers of a black bar beside a body hang on it
/// in the noise. There the share is only kept from growing.
double MostWrongSilent(const std::string& kind) {
  if (kind == "steps") return 0.08;
  return kind == "dark bar" || kind == "bar, near" ? 0.04 : 0.005;
}

/// Judges every region with more than half a percent of the scene's points.
void RunScene(const std::string& kind, std::uint32_t seed, double sensor, bool print, Tally& tally) {
  const OrderScene scene = MakeOrderScene(kind, seed, sensor);
  PhaseOptions options;
  options.direction = scene.scene.rig.direction;
  const Photograph photograph = PhotographOf(scene.scene);
  auto phase = MeasurePhase(photograph, options);
  ++tally.scenes;
  if (!phase) {
    std::cout << kind << " " << seed << ": " << phase.error().message << "\n";
    return;
  }
  const auto orders = SettleOrder(*phase, photograph.colour, scene.scene.rig, scene.distance_mm);
  const auto judged = Judge(scene, *phase, orders);
  std::size_t all = 0;
  double wrong_points = 0;
  for (const Judged& j : judged) {
    all += j.points;
    if (j.silent()) wrong_points += j.wrong * static_cast<double>(j.points);
  }
  EXPECT_LE(wrong_points, MostWrongSilent(kind) * static_cast<double>(all)) << kind << ", seed " << seed;
  bool first = true;
  for (const Judged& j : judged) {
    if (static_cast<double>(j.points) < 0.005 * static_cast<double>(all)) continue;
    if (print) Print(scene, seed, j);
    ++tally.regions;
    const bool none = j.order.source == OrderSource::kNone, right = j.wrong_by == 0;
    ++(none    ? tally.none
       : right ? (j.silent() ? tally.right_silent : tally.right_warned)
               : (j.silent() ? tally.wrong_silent : tally.wrong_warned));
    if (first && right && j.silent()) ++tally.largest_silent;
    first = false;
    EXPECT_FALSE(!right && j.silent()) << kind << ", seed " << seed << ": a region of " << j.points << " pixels is "
                                       << j.wrong_by << " stripes off by " << ToString(j.order.source);
  }
}

void PrintTally(const std::string& name, const Tally& t) {
  std::cout << std::left << std::setw(20) << name << std::right << " scenes " << t.scenes << ", regions " << t.regions
            << ": right " << t.right_silent << ", right but warned " << t.right_warned << ", wrong and warned "
            << t.wrong_warned << ", left out " << t.none << ", WRONG " << t.wrong_silent << "; largest right "
            << t.largest_silent << "\n";
}

TEST(OrderScenes, NoneIsWrongWithoutAWarning) {
  for (const std::string& kind : OrderSceneKinds()) {
    Tally tally;
    RunScene(kind, 1, 0.25, true, tally);
    EXPECT_EQ(tally.wrong_silent, 0);
  }
}

TEST(OrderScenesLong, NoneIsWrongWithoutAWarning) {
  for (const std::string& kind : OrderSceneKinds()) {
    Tally tally;
    for (std::uint32_t seed = 100; seed < 106; ++seed) RunScene(kind, seed, 0.25, true, tally);
    PrintTally(kind, tally);
    // Where the grating's ends fall on the subject a photograph is to be of use without a second look.
    const bool shows_ends =
        kind == "limb" || kind == "two limbs" || kind == "head over torso" || kind == "reference plate";
    if (shows_ends) {
      EXPECT_GE(4 * tally.largest_silent, 3 * tally.scenes) << kind;
    }
  }
}

}  // namespace
}  // namespace striae::reconstruct
