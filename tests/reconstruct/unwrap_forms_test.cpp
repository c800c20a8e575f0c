// The dual form of the unwrapping against Kruskal's, which follows the paper line by line: same pixels, same regions.
#include "reconstruct/detail/unwrap_forms.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace striae::reconstruct {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

void ExpectBothFormsAgree(const ImageF& wrapped, const Mask& mask, const Image<std::uint8_t>* misfit = nullptr) {
  const detail::Edges edges(wrapped, mask, misfit);
  const auto cuts = detail::FindCuts(edges, kNoLimit);
  ASSERT_TRUE(cuts.has_value());
  const Unwrapped dual = detail::UnwrapBetweenCuts(wrapped, mask, *cuts);
  const Unwrapped kruskal = detail::UnwrapByKruskal(edges);
  EXPECT_EQ(dual.regions, kruskal.regions);
  EXPECT_TRUE(dual.region.pixels() == kruskal.region.pixels());
  // Bytes, so that the NaN outside of the mask compare equal.
  EXPECT_EQ(std::memcmp(dual.phase.pixels().data(), kruskal.phase.pixels().data(), sizeof(float) * wrapped.size()), 0);
}

/// Tilted phase with noise of its own strength, wrapped; `noise` of 2 rad is no phase at all.
ImageF NoisyPhase(int width, int height, double noise, std::mt19937& engine) {
  std::uniform_real_distribution<double> slope(-0.6, 0.6);
  std::normal_distribution<double> gauss(0, noise);
  const double across = slope(engine), down = slope(engine);
  ImageF wrapped(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const double phase = across * col + down * row + 3 * std::sin(0.01 * col * row) + gauss(engine);
      wrapped(col, row) = static_cast<float>(std::remainder(phase, 2 * std::numbers::pi));
    }
  }
  return wrapped;
}

/// Discs added or taken out at random: holes, islands, holes in islands, single pixels, and regions apart.
Mask RandomMask(int width, int height, std::mt19937& engine) {
  std::uniform_real_distribution<double> any(0, 1);
  Mask mask(width, height, any(engine) < 0.5 ? 1 : 0);
  for (int i = 0; i < 14; ++i) {
    const double x = any(engine) * width, y = any(engine) * height, r = any(engine) * any(engine) * width / 3;
    const std::uint8_t value = any(engine) < 0.5 ? 1 : 0;
    for (int row = 0; row < height; ++row) {
      for (int col = 0; col < width; ++col) {
        if (std::hypot(col - x, row - y) < r) mask(col, row) = value;
      }
    }
  }
  if (any(engine) < 0.5) {
    const double share = 0.2 * any(engine);
    for (std::uint8_t& m : mask.pixels()) {
      if (any(engine) < share) m ^= 1;
    }
  }
  return mask;
}

TEST(UnwrapForms, AgreeOnNoiseWithoutAMask) {
  std::mt19937 engine(1);
  for (const double noise : {0.0, 0.3, 0.8, 1.5, 4.0}) {
    SCOPED_TRACE(noise);
    ExpectBothFormsAgree(NoisyPhase(97, 61, noise, engine), Mask(97, 61, 1));
  }
}

TEST(UnwrapForms, AgreeOnHolesIslandsAndNoise) {
  std::mt19937 engine(2);
  std::uniform_int_distribution<int> size(1, 70);
  std::uniform_real_distribution<double> noise(0, 2);
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    const int width = size(engine), height = size(engine);
    const ImageF wrapped = NoisyPhase(width, height, noise(engine), engine);
    ExpectBothFormsAgree(wrapped, RandomMask(width, height, engine));
  }
}

TEST(UnwrapForms, AgreeWhereTheLightMisfits) {
  std::mt19937 engine(5);
  std::uniform_int_distribution<int> kept(0, 255);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    Image<std::uint8_t> misfit(50, 41);
    for (std::uint8_t& m : misfit.pixels()) m = static_cast<std::uint8_t>(kept(engine));
    ExpectBothFormsAgree(NoisyPhase(50, 41, 1, engine), RandomMask(50, 41, engine), &misfit);
  }
}

TEST(UnwrapForms, AJumpBetweenTwoShadowsRunsWhereTheLightMisfits) {
  // A turn is gained around one hole and lost around the other: the jump between them may cross the bridge or go around
  // through the noise. The light on the bridge does not follow its stripes.
  std::mt19937 engine(6);
  std::normal_distribution<float> noise(0, 0.1F);
  Mask mask(120, 120, 1);
  ImageF wrapped(120, 120);
  Image<std::uint8_t> misfit(120, 120, 20);
  for (int row = 0; row < 120; ++row) {
    for (int col = 0; col < 120; ++col) {
      const bool bridge = col > 52 && col < 67 && row > 50 && row < 69;
      const double phase = 0.3 * row + std::atan2(row - 59.5, col - 39.5) - std::atan2(row - 59.5, col - 79.5);
      wrapped(col, row) = static_cast<float>(
          std::remainder(phase + (bridge ? 0 : static_cast<double>(noise(engine))), 2 * std::numbers::pi));
      if (std::hypot(col - 39.5, row - 59.5) < 14 || std::hypot(col - 79.5, row - 59.5) < 14) mask(col, row) = 0;
      if (bridge) misfit(col, row) = 90;
    }
  }
  const auto columns_of_cuts = [&](const Image<std::uint8_t>* known) {
    const auto cuts = detail::FindCuts(detail::Edges(wrapped, mask, known), kNoLimit);
    std::vector<int> columns;
    for (const std::uint32_t edge : cuts.value()) columns.push_back(static_cast<int>(edge / 2) % 120);
    return columns;
  };
  const auto on_bridge = [](int col) { return col >= 52 && col <= 67; };
  EXPECT_TRUE(std::ranges::all_of(columns_of_cuts(&misfit), on_bridge));
  EXPECT_FALSE(std::ranges::all_of(columns_of_cuts(nullptr), on_bridge));
}

TEST(UnwrapForms, AgreeWhereWeightsTie) {
  // Phases of four values only: most edges weigh the same, and only their place in the image decides.
  std::mt19937 engine(3);
  std::uniform_int_distribution<int> quarter(0, 3);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    ImageF wrapped(40, 33);
    for (float& phase : wrapped.pixels()) phase = static_cast<float>(quarter(engine) * std::numbers::pi / 2 - 3);
    ExpectBothFormsAgree(wrapped, RandomMask(40, 33, engine));
  }
}

TEST(UnwrapForms, AChargedHoleIsCutOnce) {
  // A whirl: the phase grows by one turn around a hole; the jump must lie on one line from the hole to the rim.
  Mask mask(60, 60, 1);
  ImageF wrapped(60, 60);
  for (int row = 0; row < 60; ++row) {
    for (int col = 0; col < 60; ++col) {
      wrapped(col, row) = static_cast<float>(std::atan2(row - 29.5, col - 29.5));
      if (std::hypot(col - 29.5, row - 29.5) < 10) mask(col, row) = 0;
    }
  }
  const auto cuts = detail::FindCuts(detail::Edges(wrapped, mask), kNoLimit);
  ASSERT_TRUE(cuts.has_value());
  EXPECT_GE(cuts->size(), 20U);  // from the hole's rim to the image's
  ExpectBothFormsAgree(wrapped, mask);
}

TEST(UnwrapForms, TheBudgetStopsTheSearch) {
  std::mt19937 engine(4);
  const Mask all(200, 200, 1);
  const ImageF noise = NoisyPhase(200, 200, 4, engine);
  EXPECT_FALSE(detail::FindCuts(detail::Edges(noise, all), 1000).has_value());  // too many residues
  const ImageF some = NoisyPhase(200, 200, 0.9, engine);
  EXPECT_FALSE(detail::FindCuts(detail::Edges(some, all), 20000).has_value());  // too many edges
}

}  // namespace
}  // namespace striae::reconstruct
