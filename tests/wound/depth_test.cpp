// The greatest depth: along the skin's own normal, and not that of a place that the surface itself doubts.
#include <cmath>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "analysis/wound/wound.h"
#include "tests/wound/bodies.h"

namespace striae::wound {
namespace {

using striae::testing::Body;
using striae::testing::Camera;
using striae::testing::CircleOn;
using striae::testing::Observe;

constexpr Camera kCamera;

AnalysisReport MeasureOrFail(const Surface& surface, const Outline& outline) {
  auto report = Measure(surface, outline);
  EXPECT_TRUE(report) << report.error().Describe();
  return report ? *report : AnalysisReport{};
}

TEST(GreatestDepth, IsAlongTheSkinsNormalFarFromTheOutlinesMiddle) {
  // A line of radius 24 mm around a crater 13 mm off its middle, where the limb leans by 17 degrees against the ring's
  // plane. Nothing has smoothed this surface, so what is given back for the Fourier window is taken off again.
  const Body body{.radius_mm = 45, .crater_radius_mm = 10, .crater_depth_mm = 7};
  Outline circle = CircleOn(body, kCamera, 24);
  for (auto& p : circle.polygon_px) p.x() += 13 * 3;
  const auto report = MeasureOrFail(Observe(body, kCamera), circle);
  const double given_back_mm = report.details["depth_max"]["window_correction_mm"].get<double>();
  const auto at_px = report.details["depth_max"]["at_px"];
  EXPECT_NEAR(std::hypot(at_px[0].get<double>() - 199.5, at_px[1].get<double>() - 199.5), 0, 3);  // the crater's middle
  EXPECT_NEAR(report.Find("depth_max")->value - given_back_mm, 7, 0.002);  // pixels of 1/3 mm on a quadric: exact
}

// A crater whose bed stands `error_mm` too deep in a strip half way up its wall.
Surface WithStrip(const Body& body, double error_mm, double uncertainty_mm) {
  Surface surface = Observe(body, kCamera);
  surface.uncertainty_mm.assign(surface.size(), 0.02F);
  for (std::size_t k = 0; k < surface.size(); ++k) {
    const double x_mm = (surface.col[k] - 199.5) / 3, y_mm = (surface.row[k] - 199.5) / 3;
    if (x_mm < 4.5 || x_mm > 6.5 || std::abs(y_mm) > 4) continue;
    auto& p = surface.point_in_camera[k];
    p *= 1 + static_cast<float>(error_mm) / p.z();
    surface.uncertainty_mm[k] = static_cast<float>(uncertainty_mm);
  }
  return surface;
}

TEST(GreatestDepth, IsNotThatOfAPlaceThatTheSurfaceDoubts) {
  const Body body{.radius_mm = 60, .crater_radius_mm = 12, .crater_depth_mm = 4};
  const Outline circle = CircleOn(body, kCamera, 12);
  // The strip's bed lies at most 3.4 mm deep and reads 1 mm deeper.
  const auto trusted = MeasureOrFail(WithStrip(body, 1, 0.02), circle);
  const auto doubted = MeasureOrFail(WithStrip(body, 1, 0.5), circle);
  EXPECT_GT(trusted.Find("depth_max")->value, 4.2);
  EXPECT_NEAR(doubted.Find("depth_max")->value, 4, 0.05);  // as CraterOn: half of it
  EXPECT_LT(std::abs(doubted.Find("depth_max")->value - 4), 2 * doubted.Find("depth_max")->uncertainty);
}

TEST(VolumeUncertainty, GrowsWithWhatTheSurfaceDoubts) {
  const Body body{.radius_mm = 60, .crater_radius_mm = 12, .crater_depth_mm = 4};
  const Outline circle = CircleOn(body, kCamera, 12);
  const double truth_ml = body.CraterVolumeMm3() / 1000;
  const auto report = MeasureOrFail(WithStrip(body, 0.3, 0.3), circle);
  const Measurement& volume = *report.Find("volume");
  // 16 mm2 that stand 0.3 mm too deep are 0.005 mL.
  EXPECT_NEAR(volume.value, truth_ml + 0.005, 0.005 * truth_ml);
  EXPECT_LT(std::abs(volume.value - truth_ml), 2 * volume.uncertainty);
  EXPECT_GT(volume.uncertainty, MeasureOrFail(WithStrip(body, 0.3, 0.02), circle).Find("volume")->uncertainty);
  EXPECT_GT(report.details["volume_uncertainty_parts_ml"]["surface"].get<double>(), 0.001);
}

}  // namespace
}  // namespace striae::wound
