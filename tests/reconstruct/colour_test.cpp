// The subject's colour without stripes: what is left at the carrier's frequency, and that no colour crosses a step.
#include "reconstruct/colour.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include "app/io/photograph.h"
#include "reconstruct/reconstruct.h"
#include "reconstruct/white_balance.h"
#include "tests/reconstruct/fringes.h"
#include "tests/support/files.h"
#include "tests/support/test_data.h"

namespace striae::reconstruct {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Power of a line's green at a period (px), Hann window.
double PowerAt(const std::vector<double>& values, double period_px) {
  double re = 0, im = 0, mean = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i);
    const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (x + 0.5) / static_cast<double>(values.size()));
    const double angle = 2 * std::numbers::pi * x / period_px;
    re += window * (values[i] - mean) * std::cos(angle);
    im += window * (values[i] - mean) * std::sin(angle);
  }
  return re * re + im * im;
}

/// Power around the carrier over that of the frequencies to both sides (0.6 to 0.85 and 1.15 to 1.4 of it), over lines
/// of 16 periods of the surface that have every pixel; `green(index of the point)` is what is looked at.
template <typename Green>
double ResidualAtCarrier(const Surface& surface, double period_px, const Green& green) {
  const auto grid = VertexIndexGrid(surface);
  const int length = static_cast<int>(16 * period_px);
  double at_carrier = 0, beside = 0;
  int lines = 0;
  for (int col = 3; col < grid.width(); col += 11) {
    for (int row = 0; row + length <= grid.height(); row += length / 2) {
      std::vector<double> values;
      for (int i = 0; i < length && grid(col, row + i) >= 0; ++i) {
        values.push_back(green(static_cast<std::size_t>(grid(col, row + i))));
      }
      if (static_cast<int>(values.size()) < length) continue;
      ++lines;
      for (const double f : {0.94, 1.0, 1.06}) at_carrier += PowerAt(values, period_px / f) / 3;
      for (const double f : {0.6, 0.7, 0.8, 1.2, 1.3, 1.4}) beside += PowerAt(values, period_px / f) / 6;
    }
  }
  EXPECT_GT(lines, 20);
  return at_carrier / beside;
}

void ExpectStripesGone(const Photograph& photograph, const Calibration& rig) {
  const auto result = Reconstruct(photograph, rig, {});
  ASSERT_TRUE(result) << result.error().message;
  const Surface& surface = result->surface;
  const double before = ResidualAtCarrier(surface, result->carrier_period_px, [&](std::size_t i) {
    return static_cast<double>(photograph.colour(surface.col[i], surface.row[i]).g);
  });
  const double after = ResidualAtCarrier(surface, result->carrier_period_px,
                                         [&](std::size_t i) { return static_cast<double>(surface.colour[i].g); });
  std::cout << "power at the carrier over its neighbours: photograph " << before << ", without stripes " << after
            << "\n";
  EXPECT_GT(before, 30);  // the stripes are there to begin with
  EXPECT_LT(after, 2);    // and do not stand out from the skin's own texture: 1 is none at all
}

TEST(Colour, NoStripesAreLeftOnATexturedWall) {
  testing::FringeScene scene{testing::SmallQuarterRig(), testing::Plane(1000, 0.05, 0.1, 150, 1e4)};
  scene.albedo = [](const Eigen::Vector3d& p) {
    return 0.55 + 0.1 * std::sin(p.x() / 7 + std::sin(p.y() / 3)) * std::cos(p.y() / 11 + p.x() / 17);
  };
  ExpectStripesGone(testing::Render(scene), scene.rig);
}

TEST(Colour, NoStripesAreLeftOnPracticePhotographs) {
  STRIAE_NEED_DATA("practice/wound_0/visit_0.jpg");
  const auto json = testing::ReadText(testing::TestData("practice/true_small.json"));
  const auto rig = CalibrationFromJson(json);
  ASSERT_TRUE(rig) << rig.error().message;
  const auto photograph = app::DecodePhotograph(testing::ReadBytes(testing::TestData("practice/wound_0/visit_0.jpg")));
  ASSERT_TRUE(photograph) << photograph.error().message;
  ExpectStripesGone(*photograph, *rig);
}

/// A line of `length` pixels, 10 px a stripe: red light up to `step`, blue light after it, black between the stripes.
struct Step {
  ImageRgb photograph;
  ImageF order;
};
Step TwoSurfaces(int length, int step, float jump) {
  Step scene{ImageRgb(1, length), ImageF(1, length)};
  for (int x = 0; x < length; ++x) {
    const float order = 0.1F * static_cast<float>(x) + (x < step ? 0 : jump);
    const bool bright = std::abs(order - std::nearbyint(order)) < 0.25F;
    const Rgb8 light = x < step ? Rgb8{200, 0, 0} : Rgb8{0, 0, 200};
    scene.photograph(0, x) = bright ? light : Rgb8{};
    scene.order(0, x) = order;
  }
  return scene;
}

TEST(Colour, NeverCrossesAStepInDepth) {
  for (const float jump : {3.4F, -2.0F, 0.5F}) {
    const Step scene = TwoSurfaces(200, 97, jump);
    const ImageRgb colour = ColourWithoutStripes(scene.photograph, scene.order, StripeDirection::kHorizontal);
    for (int x = 0; x < 200; ++x) EXPECT_EQ(colour(0, x), x < 97 ? (Rgb8{200, 0, 0}) : (Rgb8{0, 0, 200})) << x;
  }
}

TEST(Colour, NeverCrossesAGap) {
  Step scene = TwoSurfaces(200, 97, 0);
  for (int x = 95; x < 99; ++x) scene.order(0, x) = kNone;
  const ImageRgb colour = ColourWithoutStripes(scene.photograph, scene.order, StripeDirection::kHorizontal);
  for (int x = 0; x < 95; ++x) EXPECT_EQ(colour(0, x), (Rgb8{200, 0, 0})) << x;
  for (int x = 99; x < 200; ++x) EXPECT_EQ(colour(0, x), (Rgb8{0, 0, 200})) << x;
  for (int x = 95; x < 99; ++x) EXPECT_EQ(colour(0, x), scene.photograph(0, x)) << x;  // nothing is known there
}

TEST(Colour, IsTheSameAcrossEitherDirection) {
  const Step scene = TwoSurfaces(200, 97, 3.4F);
  const ImageRgb down = ColourWithoutStripes(scene.photograph, scene.order, StripeDirection::kHorizontal);
  Step turned{ImageRgb(200, 1), ImageF(200, 1)};
  for (int x = 0; x < 200; ++x) {
    turned.photograph(x, 0) = scene.photograph(0, x);
    turned.order(x, 0) = scene.order(0, x);
  }
  const ImageRgb along = ColourWithoutStripes(turned.photograph, turned.order, StripeDirection::kVertical);
  for (int x = 0; x < 200; ++x) EXPECT_EQ(along(x, 0), down(0, x)) << x;
}

TEST(WhiteBalance, MakesTheCardGreyAndKeepsItsBrightness) {
  Surface surface;
  surface.sensor_width_px = surface.sensor_height_px = 400;
  for (std::uint16_t i = 0; i < 400; ++i) {
    surface.point_in_camera.emplace_back(0, 0, 1000);
    surface.colour.push_back(i < 200 ? Rgb8{180, 120, 90} : Rgb8{40, 60, 200});
    surface.quality.push_back(1);
    surface.col.push_back(i);
    surface.row.push_back(50);
  }
  const auto card = WhiteBalanceFrom("grey-card=100,55");
  ASSERT_TRUE(card);
  const auto gains = Balance(*card, surface);
  ASSERT_TRUE(gains) << gains.error().message;
  EXPECT_EQ(surface.colour[10].r, surface.colour[10].g);
  EXPECT_EQ(surface.colour[10].g, surface.colour[10].b);
  EXPECT_GT(surface.colour[10].g, 120);  // between the card's red and its blue
  EXPECT_LT(surface.colour[10].g, 180);
  EXPECT_LT(surface.colour[300].r, 40);                                    // the same factors everywhere
  EXPECT_FALSE(Balance(*WhiteBalanceFrom("grey-card=100,200"), surface));  // no point of the surface is there
}

TEST(WhiteBalance, RefusesWordsThatMeanNothing) {
  for (const char* text : {"", "flashy", "grey-card", "grey-card=", "grey-card=5", "grey-card=5,", "grey-card=5,x"}) {
    const auto balance = WhiteBalanceFrom(text);
    ASSERT_FALSE(balance) << text;
    EXPECT_EQ(balance.error().code, ErrorCode::kUsage);
  }
}

}  // namespace
}  // namespace striae::reconstruct
