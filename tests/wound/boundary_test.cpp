// Boundaries proposed from a rough box or strokes, against circles drawn on known bodies.
#include "analysis/wound/boundary.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "analysis/wound/wound.h"
#include "tests/wound/bodies.h"

namespace striae::wound {
namespace {

using striae::testing::Body;
using striae::testing::Camera;
using striae::testing::CircleOn;
using striae::testing::Noise;
using striae::testing::Observe;

constexpr Camera kCamera;

// Red inside the circle, skin outside, with camera noise of 6 of 255; `red` 0 leaves all skin.
Surface Painted(const Body& body, double radius_mm, int red) {
  Surface surface = Observe(body, kCamera, Noise{.white_mm = 0.05});
  const Outline circle = CircleOn(body, kCamera, radius_mm);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 6);
  for (std::size_t k = 0; k < surface.size(); ++k) {
    const bool in = Inside(circle.polygon_px, Eigen::Vector2d(surface.col[k], surface.row[k]));
    const auto shade = [&](double value) {
      return static_cast<std::uint8_t>(std::clamp(value + noise(random), 0.0, 255.0));
    };
    surface.colour[k] = {shade(200), shade(160 - (in ? red : 0)), shade(145 - (in ? red : 0))};
  }
  return surface;
}

BoundaryHints Box(const Outline& circle, double by_px, double dx = 0, double dy = 0) {
  Eigen::Vector2d low = circle.polygon_px.front(), high = low;
  for (const auto& p : circle.polygon_px) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d shift(dx, dy), grow(by_px, by_px);
  return {.box = {low - grow + shift, high + grow + shift}};
}

double AreaPx(const Outline& outline) {
  double twice = 0;
  for (std::size_t k = 0; k < outline.polygon_px.size(); ++k) {
    const auto& a = outline.polygon_px[k];
    const auto& b = outline.polygon_px[(k + 1) % outline.polygon_px.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

TEST(Boundary, OfARedBedIsFoundFromARoughBox) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 3};
  const Outline circle = CircleOn(body, kCamera, 12);
  const auto found = ProposeBoundary(Painted(body, 12, 45), Box(circle, 12));
  ASSERT_TRUE(found) << found.error().Describe();
  // A quarter of a pixel (0.08 mm) all around a circle of 36 px is 1.4 % of its area; twice that.
  EXPECT_NEAR(AreaPx(found->outline), AreaPx(circle), 0.03 * AreaPx(circle));
  EXPECT_GT(found->confidence, 0.9);
  EXPECT_FALSE(SelfCrossing(found->outline.polygon_px));
  EXPECT_TRUE(Measure(Painted(body, 12, 45), found->outline));
}

TEST(Boundary, BarelyDependsOnWhereTheBoxWasDrawn) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 3};
  const Outline circle = CircleOn(body, kCamera, 12);
  const Surface surface = Painted(body, 12, 45);
  std::mt19937 random(3);
  std::normal_distribution<double> off(0, 4);  // px: 1.3 mm
  std::vector<double> areas;
  double mean = 0, squares = 0;
  for (int k = 0; k < 6; ++k) {
    const auto found = ProposeBoundary(surface, Box(circle, 12 + off(random), off(random), off(random)));
    ASSERT_TRUE(found) << found.error().Describe();
    areas.push_back(AreaPx(found->outline));
    mean += areas.back() / 6;
  }
  for (const double area : areas) squares += (area - mean) * (area - mean) / 5;
  RecordProperty("area_cv_percent", std::to_string(100 * std::sqrt(squares) / mean));
  EXPECT_LT(std::sqrt(squares) / mean, 0.015);  // the bar of hand-held repeats
}

// The photograph of it: the red circle under stripes of 2 mm whose dark reflects a tenth of their light, with noise.
ImageRgb StripedPhotograph(const Outline& circle) {
  ImageRgb photograph(kCamera.width, kCamera.height);
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 3);
  for (int row = 0; row < photograph.height(); ++row) {
    const double light = 0.55 + 0.45 * std::cos(2 * M_PI * row / 6.0);
    for (int col = 0; col < photograph.width(); ++col) {
      const bool in = Inside(circle.polygon_px, Eigen::Vector2d(col, row));
      const auto shade = [&](double value) {  // of light, so that its square root is near enough to sRGB
        return static_cast<std::uint8_t>(std::clamp(value * std::sqrt(light) + noise(random), 0.0, 255.0));
      };
      photograph(col, row) = {shade(200), shade(in ? 115 : 160), shade(in ? 100 : 145)};
    }
  }
  return photograph;
}

// What lies around the rim is missing: walls that no light reaches.
Surface WithoutItsWalls(const Surface& surface, const Body& body) {
  const Outline inner = CircleOn(body, kCamera, 10.5), outer = CircleOn(body, kCamera, 12.5);
  return striae::testing::Keep(surface, [&](int col, int row) {
    const Eigen::Vector2d p(col, row);
    return Inside(inner.polygon_px, p) || !Inside(outer.polygon_px, p);
  });
}

TEST(Boundary, IsFoundOnThePhotographWhereTheSurfaceLacksTheWalls) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 6};
  const Outline circle = CircleOn(body, kCamera, 12);
  const Surface surface = WithoutItsWalls(Painted(body, 12, 45), body);
  const ImageRgb photograph = StripedPhotograph(circle);
  const auto seen = ProposeBoundary(surface, Box(circle, 12), {}, &photograph);
  ASSERT_TRUE(seen) << seen.error().Describe();
  // A quarter of a pixel all around, as above.
  EXPECT_NEAR(AreaPx(seen->outline), AreaPx(circle), 0.015 * AreaPx(circle));
  EXPECT_GT(seen->confidence, 0.9);
  // From the surface alone the wall is the wound's: its rim lies somewhere in the 2 mm that are missing.
  const auto guessed = ProposeBoundary(surface, Box(circle, 12));
  ASSERT_TRUE(guessed) << guessed.error().Describe();
  EXPECT_GT(AreaPx(guessed->outline), std::pow(10.5 / 12, 2) * AreaPx(circle));
  EXPECT_LT(AreaPx(guessed->outline), std::pow(12.9 / 12, 2) * AreaPx(circle));

  const auto repeats = RepeatBoundary(surface, Box(circle, 12), *seen, {}, &photograph);
  EXPECT_EQ(repeats.tried, 8);
  EXPECT_EQ(repeats.found, 8);
  EXPECT_LT(repeats.area_cv, 0.005);  // hints 1.5 mm off move a line that the picture shows by nothing
  EXPECT_LT(repeats.line_sd_mm, 0.1);
  EXPECT_GT(repeats.line_sd_mm, 0);
}

TEST(Boundary, MovesADrawnOutlineToTheEdgeThatThePhotographShows) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 6};
  const Outline circle = CircleOn(body, kCamera, 12);
  const Surface surface = WithoutItsWalls(Painted(body, 12, 45), body);
  const ImageRgb photograph = StripedPhotograph(circle);
  Outline drawn = CircleOn(body, kCamera, 12.6, 24);  // 10 % too large, and shaken by half a millimetre
  std::mt19937 random(7);
  std::normal_distribution<double> off(0, 1.5);
  for (auto& p : drawn.polygon_px) p += Eigen::Vector2d(off(random), off(random));
  const auto moved = ProposeBoundary(surface, {.drawn = drawn}, {}, &photograph);
  ASSERT_TRUE(moved) << moved.error().Describe();
  EXPECT_GT(std::abs(AreaPx(drawn) - AreaPx(circle)), 0.05 * AreaPx(circle));
  EXPECT_NEAR(AreaPx(moved->outline), AreaPx(circle), 0.015 * AreaPx(circle));  // as from a box
  const auto repeats = RepeatBoundary(surface, {.drawn = drawn}, *moved, {}, &photograph);
  EXPECT_EQ(repeats.shaken_mm, 0.5);
  EXPECT_EQ(repeats.found, repeats.tried);
  EXPECT_LT(repeats.area_cv, 0.005);
}

TEST(Boundary, RefusesAPhotographOfAnotherSize) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 3};
  const ImageRgb other(kCamera.width / 2, kCamera.height / 2);
  const auto found = ProposeBoundary(Painted(body, 12, 45), Box(CircleOn(body, kCamera, 12), 12), {}, &other);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::kUsage);
}

TEST(Boundary, IsFoundByShapeWhereTheColourIsTheSkins) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 5};
  const Outline circle = CircleOn(body, kCamera, 12);
  const auto found = ProposeBoundary(Painted(body, 12, 0), Box(circle, 12));
  ASSERT_TRUE(found) << found.error().Describe();
  // The parabola's rim has no depth: where it is half of what counts as deep (1.2 mm) its radius is 0.87 of the rim's.
  EXPECT_NEAR(AreaPx(found->outline), 0.88 * AreaPx(circle), 0.14 * AreaPx(circle));
}

TEST(Boundary, FollowsStrokesInTheWound) {
  const Body body{.radius_mm = 55, .crater_radius_mm = 12, .crater_depth_mm = 3};
  const Outline circle = CircleOn(body, kCamera, 12), inner = CircleOn(body, kCamera, 7);
  const auto found = ProposeBoundary(Painted(body, 12, 45), {.wound_strokes = {inner.polygon_px}});
  ASSERT_TRUE(found) << found.error().Describe();
  EXPECT_NEAR(AreaPx(found->outline), AreaPx(circle), 0.03 * AreaPx(circle));
}

TEST(Boundary, SaysSoWhereThereIsNoWound) {
  const Body body{.radius_mm = 55, .crater_depth_mm = 0};
  const auto found = ProposeBoundary(Painted(body, 12, 0), Box(CircleOn(body, kCamera, 12), 12));
  if (found) {
    EXPECT_LT(found->confidence, 0.3);  // something is always a little different
  } else {
    EXPECT_EQ(found.error().code, ErrorCode::kMeasurementRefused);
  }
}

TEST(Boundary, RefusesHintsThatEncloseNothing) {
  const Surface surface = Painted({.radius_mm = 55}, 12, 45);
  EXPECT_EQ(ProposeBoundary(surface, {}).error().code, ErrorCode::kUsage);
  EXPECT_EQ(ProposeBoundary(surface, {.box = {{10, 10}, {10, 40}}}).error().code, ErrorCode::kUsage);
  EXPECT_EQ(ProposeBoundary(surface, {.box = {{0, 0}, {8, 8}}}).error().code, ErrorCode::kOutlineOffSurface);
}

}  // namespace
}  // namespace striae::wound
