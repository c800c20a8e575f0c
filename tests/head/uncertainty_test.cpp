#include "analysis/head/detail/uncertainty.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace striae::head::detail {
namespace {

using Eigen::Vector3d;

/// Pairs on a patch z = f(x, y) of 100 mm by 100 mm, 2 mm apart, with noise along the normal.
template <typename Shape>
std::vector<Pair> PairsOn(const Shape& height, double noise_mm, std::uint32_t seed) {
  std::vector<Pair> pairs;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int i = -25; i <= 25; ++i) {
    for (int k = -25; k <= 25; ++k) {
      const double x = 2.0 * i, y = 2.0 * k, e = 1e-4;
      const Vector3d n =
          Vector3d((height(x - e, y) - height(x + e, y)) / (2 * e), (height(x, y - e) - height(x, y + e)) / (2 * e), 1)
              .normalized();
      const Vector3d p(x, y, height(x, y));
      pairs.push_back({p + noise_mm * normal(random) * n, p, n});
    }
  }
  return pairs;
}

double Sphere(double x, double y) { return std::sqrt(100.0 * 100 - x * x - y * y); }
double Plane(double x, double y) { return 0.1 * x + 0.2 * y; }
double Bumps(double x, double y) { return 8 * std::sin(x / 12) * std::sin(y / 12); }

TEST(Observability, SphereAndPlaneDoNotResistTurning) {
  // Exact shapes; differentiation leaves 1e-6.
  EXPECT_LT(Observability_mm(PairsOn(Sphere, 0, 1)), 0.01);
  EXPECT_LT(Observability_mm(PairsOn(Plane, 0, 1)), 0.01);
}

TEST(Observability, BumpsResistAboutEveryAxis) {
  // About z the points shift by y dz/dx - x dz/dy per rad: slopes of 0.33 rms at arms of 29 mm rms, 13 mm in all; about
  // x and y by 29 mm rms. Normals that lean take a tenth or two away.
  EXPECT_GT(Observability_mm(PairsOn(Bumps, 0, 1)), 8);
}

TEST(Bootstrap, AgreesWithTheSpreadOfRepeatedNoise) {
  // Truth: draw the noise of a bumpy patch 200 times and look at the fitted turn itself.
  const double noise_mm = 0.5;
  double squares = 0;
  const int repeats = 200;
  for (std::uint32_t seed = 0; seed < repeats; ++seed) {
    Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    for (const Pair& pair : PairsOn(Bumps, noise_mm, seed)) {
      Eigen::Matrix<double, 6, 1> row;
      row << pair.target.cross(pair.normal), pair.normal;
      m += row * row.transpose();
      b -= row * pair.ToPlane();
    }
    squares += m.ldlt().solve(b).head<3>().squaredNorm();
  }
  const double true_sd = std::sqrt(squares / repeats);
  double sample_squares = 0;
  const int patches = 20, resamples = 100;
  for (std::uint32_t seed = 1000; seed < 1000 + patches; ++seed) {
    const auto samples = BootstrapRotations(PairsOn(Bumps, noise_mm, seed), 20, resamples, 1);
    ASSERT_EQ(samples.size(), static_cast<std::size_t>(resamples));
    for (const auto& sample : samples) sample_squares += sample.squaredNorm();
  }
  // The true sd is known to 3 %, the mean of 20 patches to 5 %; some 30 cells of uneven filling, of which a resample
  // may miss the outermost, make the bootstrap a little wide.
  EXPECT_NEAR(std::sqrt(sample_squares / (patches * resamples)) / true_sd, 1.05, 0.2);
}

TEST(Bootstrap, SameSeedSameSamples) {
  const auto pairs = PairsOn(Bumps, 0.5, 3);
  EXPECT_EQ(BootstrapRotations(pairs, 30, 20, 7), BootstrapRotations(pairs, 30, 20, 7));
  EXPECT_NE(BootstrapRotations(pairs, 30, 20, 7), BootstrapRotations(pairs, 30, 20, 8));
}

TEST(Bootstrap, TooFewCellsGiveNone) { EXPECT_TRUE(BootstrapRotations(PairsOn(Bumps, 0.5, 3), 500, 20, 7).empty()); }

}  // namespace
}  // namespace striae::head::detail
