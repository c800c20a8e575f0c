// The practice limbs: another program's rendering, with the wounds' true volumes, areas and depths.
#include <cmath>
#include <iostream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "analysis/wound/wound.h"
#include "tests/support/depth_map.h"
#include "tests/support/files.h"
#include "tests/support/test_data.h"

namespace striae::wound {
namespace {

using striae::testing::TestData;

// The true depths on the true rays, all of them good: a sensor of an eighth of the size.
Surface TrueSurface(const std::filesystem::path& depth_map, const CameraModel& camera) {
  Surface surface = testing::SurfaceFromDepthMap(depth_map, camera);
  surface.colour.resize(surface.size());
  surface.quality.assign(surface.size(), 1);
  return surface;
}

TEST(PracticeWounds, TrueDepthMapsGiveTheTrueVolumeAreaAndDepth) {
  STRIAE_NEED_DATA("practice/wound_0/truth.json");
  const auto calibration = CalibrationFromJson(testing::ReadText(TestData("practice/true_small.json")));
  ASSERT_TRUE(calibration);
  std::vector<double> volume_errors;
  for (const std::string limb : {"wound_0", "wound_1"}) {
    for (const auto& visit : nlohmann::json::parse(testing::ReadText(TestData("practice/" + limb + "/truth.json")))) {
      const auto name = limb + "/visit_" + std::to_string(visit.at("visit").get<int>());
      SCOPED_TRACE(name);
      const auto surface = TrueSurface(TestData("practice/" + name + ".depth8.tiff"), calibration->camera);
      Outline outline;
      for (const auto& p : visit.at("outline_px")) {
        outline.polygon_px.emplace_back(p.at(0).get<double>() / 8, p.at(1).get<double>() / 8);
      }
      const auto report = Measure(surface, outline);
      ASSERT_TRUE(report) << report.error().Describe();
      const auto error = [&](const char* quantity, const char* truth) {
        return 100 * (report->Find(quantity)->value / visit.at(truth).get<double>() - 1);
      };
      volume_errors.push_back(std::abs(error("volume", "volume_ml")));
      std::cout << name << ": error of volume " << error("volume", "volume_ml") << " % (standard uncertainty "
                << 100 * report->Find("volume")->uncertainty / report->Find("volume")->value << " %), area "
                << error("area", "skin_area_cm2") << " %, bed " << error("bed_area", "surface_area_cm2") << " %, depth "
                << error("depth_max", "max_depth_mm") << " %\n";
      if (std::getenv("WOUND_DUMP")) std::cout << ToJson(*report).dump(1) << "\n";
    }
  }
  std::sort(volume_errors.begin(), volume_errors.end());
  EXPECT_LE(volume_errors[volume_errors.size() / 2], 2);
}

}  // namespace
}  // namespace striae::wound
