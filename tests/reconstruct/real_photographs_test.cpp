// Real fringe photographs from other rigs (skipped where the data is absent).
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numbers>

#include <gmock/gmock.h>

#include "app/io/photograph.h"
#include "core/optics.h"
#include "core/ply.h"
#include "reconstruct/reconstruct.h"
#include "tests/support/test_data.h"

namespace striae::reconstruct {
namespace {

using striae::testing::TestData;

std::vector<std::uint8_t> Bytes(const std::string& name) {
  std::ifstream file(TestData(name), std::ios::binary);
  return {(std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>()};
}

Photograph Read(const std::string& name) {
  auto photograph = app::DecodePhotograph(Bytes(name));
  if (!photograph) throw std::runtime_error(photograph.error().message);
  return *std::move(photograph);
}

double Percentile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

TEST(DavidBust, DepthAgainstTwoCameraStereo) {
  STRIAE_NEED_DATA("david_bust/left.png");
  const auto json = Bytes("david_bust/left.json");
  const auto rig = CalibrationFromJson({reinterpret_cast<const char*>(json.data()), json.size()});
  ASSERT_TRUE(rig) << rig.error().message;
  const auto truth = DecodePly(Bytes("david_bust/truth_left.ply"));
  ASSERT_TRUE(truth) << truth.error().message;
  const auto result = Reconstruct(Read("david_bust/left.png"), *rig, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->direction, StripeDirection::kVertical);
  const auto grid = VertexIndexGrid(result->surface);
  std::vector<double> errors;
  for (const auto& point : truth->point_in_camera) {
    const Eigen::Vector2d pixel = Project(rig->camera, point.cast<double>());
    const int col = static_cast<int>(std::lround(pixel.x())), row = static_cast<int>(std::lround(pixel.y()));
    if (!grid.Contains(col, row) || grid(col, row) < 0) continue;
    const auto& found = result->surface.point_in_camera[static_cast<std::size_t>(grid(col, row))];
    errors.push_back(std::abs(found.z() - point.z()));
  }
  const double covered = static_cast<double>(errors.size()) / static_cast<double>(truth->size());
  std::cout << "david: median " << Percentile(errors, 0.5) << " mm, 90th percentile " << Percentile(errors, 0.9)
            << " mm, on " << 100 * covered << " % of the truth\n";
  // What a plain numpy FTP with scikit-image reaches on the same photograph; the truth's own noise is about 1.5 mm.
  EXPECT_LE(Percentile(errors, 0.5), 3.1);
  EXPECT_LE(Percentile(errors, 0.9), 12.5);
  EXPECT_GT(covered, 0.82);  // a bar that could be met by leaving out the hard parts would mean nothing
}

TEST(LensFringes, SingleFrameAgainstTheFourStepPhase) {
  STRIAE_NEED_DATA("lens_fringes/lens_crop_000.jpg");
  Photograph frames[4];
  const char* names[] = {"000", "090", "180", "270"};
  for (int i = 0; i < 4; ++i) frames[i] = Read("lens_fringes/lens_crop_" + std::string(names[i]) + ".jpg");
  const auto phase = MeasurePhase(frames[0]);
  ASSERT_TRUE(phase) << phase.error().message;
  EXPECT_EQ(phase->direction, StripeDirection::kVertical);
  EXPECT_NEAR(phase->carrier_period_px, 36.4, 1.5);
  std::vector<double> errors;
  double cosine = 0, sine = 0;
  const auto difference = [&](int col, int row) {
    const double i0 = frames[0].luminance(col, row), i90 = frames[1].luminance(col, row),
                 i180 = frames[2].luminance(col, row), i270 = frames[3].luminance(col, row);
    // The sign of the steps differs between rigs: the growing direction is the one of the carrier.
    return std::remainder(phase->unwrapped.phase(col, row) - std::atan2(i90 - i270, i0 - i180), 2 * std::numbers::pi);
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (int row = 0; row < phase->mask.height(); ++row) {
      for (int col = 0; col < phase->mask.width(); ++col) {
        if (phase->mask(col, row) == 0) continue;
        const double d = difference(col, row);
        if (pass == 0) {
          cosine += std::cos(d);
          sine += std::sin(d);
        } else {
          errors.push_back(std::abs(std::remainder(d - std::atan2(sine, cosine), 2 * std::numbers::pi)));
        }
      }
    }
  }
  std::cout << "lens: median " << Percentile(errors, 0.5) << " rad over "
            << 100.0 * static_cast<double>(errors.size()) / static_cast<double>(phase->mask.size())
            << " % of the pixels\n";
  EXPECT_LT(Percentile(errors, 0.5), 0.34);  // a plain FTP (data's own note)
}

}  // namespace
}  // namespace striae::reconstruct
