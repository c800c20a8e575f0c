// Every photograph of the practice set, which another program rendered with rigs of its own: each region's whole number
// against the true depth.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>

#include <gmock/gmock.h>

#include "app/io/photograph.h"
#include "core/optics.h"
#include "reconstruct/order.h"
#include "tests/support/depth_map.h"
#include "tests/support/test_data.h"

namespace striae::reconstruct {
namespace {

namespace fs = std::filesystem;
using striae::testing::kDepthMapStep_px;
using striae::testing::ReadDepthMap;
using striae::testing::TestData;

std::vector<std::uint8_t> BytesOf(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

Calibration RigOf(const std::string& name) {
  const auto bytes = BytesOf(TestData("practice/" + name));
  auto rig = CalibrationFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!rig) throw std::runtime_error(rig.error().message);
  return *std::move(rig);
}

/// True minus measured order of each region at the truth's pixels, rounded; sorted.
std::vector<std::vector<int>> TrueOffsets(const PhaseResult& phase, const Calibration& rig, const ImageF& truth) {
  const StripeOptics optics(rig);
  std::vector<std::vector<int>> offsets(static_cast<std::size_t>(phase.unwrapped.regions));
  for (int row = 0; row < truth.height(); ++row) {
    for (int col = 0; col < truth.width(); ++col) {
      const int x = col * kDepthMapStep_px, y = row * kDepthMapStep_px;
      if (!phase.mask.Contains(x, y) || !(truth(col, row) > 0)) continue;
      const int region = phase.unwrapped.region(x, y);
      if (region < 0) continue;
      const auto order =
          optics.OrderAt(truth(col, row) * RayOf(rig.camera, {static_cast<double>(x), static_cast<double>(y)}));
      if (order) {
        offsets[static_cast<std::size_t>(region)].push_back(
            static_cast<int>(std::lround(*order - phase.unwrapped.phase(x, y) / (2 * std::numbers::pi))));
      }
    }
  }
  for (auto& of : offsets) std::sort(of.begin(), of.end());
  return offsets;
}

void Judge(const fs::path& image, const Calibration& rig) {
  const auto photograph = app::DecodePhotograph(BytesOf(image));
  ASSERT_TRUE(photograph) << image;
  PhaseOptions options;
  options.direction = rig.direction;
  auto phase = MeasurePhase(*photograph, options);
  ASSERT_TRUE(phase) << image;
  const auto orders = SettleOrder(*phase, photograph->colour, rig, (rig.near_mm + rig.far_mm) / 2);
  const auto offsets = TrueOffsets(*phase, rig, ReadDepthMap(fs::path(image).replace_extension(".depth8.tiff")));
  constexpr std::size_t kFewest = 30;  // samples of the truth, one for 64 pixels
  for (std::size_t r = 0; r < orders.size(); ++r) {
    if (offsets[r].size() < kFewest) continue;
    const int truth = offsets[r][offsets[r].size() / 2];
    const auto agreeing = std::count(offsets[r].begin(), offsets[r].end(), truth);
    const bool none = orders[r].source == OrderSource::kNone;
    std::cout << image.parent_path().filename().string() << "/" << image.filename().string() << " region " << r
              << " of " << orders[r].points << " px: " << ToString(orders[r].source) << ", margin " << orders[r].margin
              << ", off by " << orders[r].offset - truth << ", "
              << 100 * agreeing / static_cast<long>(offsets[r].size()) << " % of it alike"
              << (orders[r].warning.empty() ? "" : ", warned") << "\n";
    // The plane wholly inside of the field shows no end of the stripes; everything else does.
    if (r == 0 && image.stem() != "plane_small") {
      EXPECT_EQ(orders[r].source, OrderSource::kGratingEdge) << image;
      EXPECT_EQ(orders[r].warning, "") << image;
    }
    EXPECT_TRUE(none || !orders[r].warning.empty() || orders[r].offset == truth) << image << " region " << r;
  }
}

TEST(OrderPracticeLong, NoWholeNumberIsWrongWithoutAWarning) {
  STRIAE_NEED_DATA("practice/true_small.json");
  std::vector<fs::path> images;
  for (const auto& entry : fs::recursive_directory_iterator(TestData("practice"))) {
    if (entry.path().extension() == ".jpg" && fs::exists(fs::path(entry.path()).replace_extension(".depth8.tiff"))) {
      images.push_back(entry.path());
    }
  }
  std::sort(images.begin(), images.end());
  ASSERT_FALSE(images.empty());
  for (const fs::path& image : images) {
    const bool large = image.parent_path().filename() == "head" || image.filename().string().starts_with("large");
    Judge(image, RigOf(large ? "true_large.json" : "true_small.json"));
  }
}

}  // namespace
}  // namespace striae::reconstruct
