// The practice limbs: another program's rendering, with the wounds' true volumes, areas and depths.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "analysis/wound/wound.h"
#include "core/optics.h"
#include "tests/support/test_data.h"

namespace striae::wound {
namespace {

using striae::testing::TestData;

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
T At(const std::string& bytes, std::size_t offset) {
  T value;
  if (offset + sizeof value > bytes.size()) throw std::runtime_error("TIFF is cut short");
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Just enough TIFF for the truth files: little-endian, uncompressed float32 strips.
ImageF ReadDepthTiff(const std::filesystem::path& path) {
  const std::string bytes = ReadAll(path);
  const auto directory = At<std::uint32_t>(bytes, 4);
  std::uint32_t width = 0, height = 0, strips = 0, strips_at = 0, rows_per_strip = 0;
  for (std::uint16_t k = 0; k < At<std::uint16_t>(bytes, directory); ++k) {
    const std::size_t entry = directory + 2 + 12U * k;
    const auto tag = At<std::uint16_t>(bytes, entry), type = At<std::uint16_t>(bytes, entry + 2);
    const auto value = type == 3 ? At<std::uint16_t>(bytes, entry + 8) : At<std::uint32_t>(bytes, entry + 8);
    if (tag == 256) width = value;
    if (tag == 257) height = value;
    if (tag == 278) rows_per_strip = value;
    if (tag == 273) {
      strips = At<std::uint32_t>(bytes, entry + 4);
      strips_at = strips == 1 ? static_cast<std::uint32_t>(entry + 8) : value;
    }
  }
  ImageF depth(static_cast<int>(width), static_cast<int>(height));
  for (std::uint32_t s = 0; s < strips; ++s) {
    const auto at = At<std::uint32_t>(bytes, strips_at + 4 * s);
    for (std::uint32_t row = s * rows_per_strip; row < std::min(height, (s + 1) * rows_per_strip); ++row) {
      for (std::uint32_t col = 0; col < width; ++col) {
        depth(static_cast<int>(col), static_cast<int>(row)) =
            At<float>(bytes, at + 4 * ((row - s * rows_per_strip) * std::size_t{width} + col));
      }
    }
  }
  return depth;
}

// A sensor of an eighth of the size: the depth at every 8th pixel, on that pixel's true ray.
Surface TrueSurface(const ImageF& depth, const CameraModel& camera) {
  Surface surface;
  surface.sensor_width_px = depth.width();
  surface.sensor_height_px = depth.height();
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      if (!(depth(col, row) > 0)) continue;
      const Eigen::Vector3d p = depth(col, row) * RayOf(camera, {8.0 * col, 8.0 * row});
      surface.point_in_camera.push_back(p.cast<float>());
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  surface.colour.resize(surface.size());
  surface.quality.assign(surface.size(), 1);
  return surface;
}

TEST(PracticeWounds, TrueDepthMapsGiveTheTrueVolumeAreaAndDepth) {
  STRIAE_NEED_DATA("practice/wound_0/truth.json");
  const auto calibration = CalibrationFromJson(ReadAll(TestData("practice/true_small.json")));
  ASSERT_TRUE(calibration);
  std::vector<double> volume_errors;
  for (const std::string limb : {"wound_0", "wound_1"}) {
    for (const auto& visit : nlohmann::json::parse(ReadAll(TestData("practice/" + limb + "/truth.json")))) {
      const auto name = limb + "/visit_" + std::to_string(visit.at("visit").get<int>());
      SCOPED_TRACE(name);
      const auto surface =
          TrueSurface(ReadDepthTiff(TestData("practice/" + name + ".depth8.tiff")), calibration->camera);
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
