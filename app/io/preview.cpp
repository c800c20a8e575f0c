#include "app/io/preview.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "app/io/colour_bar.h"
#include "report/picture.h"

namespace striae::app {
namespace {

constexpr Rgb8 kWhite{255, 255, 255};

/// The part of the sensor that has points, with a margin of 2 %.
struct Cut {
  int col = 0, row = 0, width = 0, height = 0;
};

Cut CutOf(const Surface& surface) {
  const auto [left, right] = std::minmax_element(surface.col.begin(), surface.col.end());
  const auto [top, bottom] = std::minmax_element(surface.row.begin(), surface.row.end());
  const int margin = std::max(*right - *left, *bottom - *top) / 50;
  Cut cut;
  cut.col = std::max(0, *left - margin);
  cut.row = std::max(0, *top - margin);
  cut.width = std::min(surface.sensor_width_px, *right + margin + 1) - cut.col;
  cut.height = std::min(surface.sensor_height_px, *bottom + margin + 1) - cut.row;
  return cut;
}

/// The points of each cell of a coarser grid, averaged; cells without points stay empty.
struct Cells {
  Image<Eigen::Vector3f> mean_point;
  Image<float> count;
  double step_px = 1;
};

Cells Average(const Surface& surface, const Cut& cut, int max_width, int max_height) {
  Cells cells;
  cells.step_px = std::max({1.0, static_cast<double>(cut.width) / std::max(1, max_width),
                            static_cast<double>(cut.height) / std::max(1, max_height)});
  const int width = std::max(1, static_cast<int>(std::ceil(cut.width / cells.step_px)));
  const int height = std::max(1, static_cast<int>(std::ceil(cut.height / cells.step_px)));
  cells.mean_point = Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero());
  cells.count = Image<float>(width, height, 0);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const int x = std::min(width - 1, static_cast<int>((surface.col[i] - cut.col) / cells.step_px));
    const int y = std::min(height - 1, static_cast<int>((surface.row[i] - cut.row) / cells.step_px));
    cells.mean_point(x, y) += surface.point_in_camera[i];
    cells.count(x, y) += 1;
  }
  for (std::size_t i = 0; i < cells.count.size(); ++i) {
    if (cells.count.pixels()[i] > 0) cells.mean_point.pixels()[i] /= cells.count.pixels()[i];
  }
  return cells;
}

Status CheckDrawable(const Surface& surface) {
  if (surface.size() == 0 || !surface.HasGrid()) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the surface has no points on the sensor grid, so there is no depth map");
  }
  return {};
}

}  // namespace

Result<DepthRange> RobustDepthRange(const Surface& surface) {
  if (surface.size() == 0) return Fail(ErrorCode::kMeasurementRefused, "the surface has no points, so it has no depth");
  std::vector<float> depth(surface.size());
  std::transform(surface.point_in_camera.begin(), surface.point_in_camera.end(), depth.begin(),
                 [](const Eigen::Vector3f& p) { return p.z(); });
  const auto quantile = [&](double share) {
    const auto at = depth.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(depth.size() - 1));
    std::nth_element(depth.begin(), at, depth.end());
    return static_cast<double>(*at);
  };
  DepthRange range{std::floor(quantile(0.01)), std::ceil(quantile(0.99))};
  if (range.far_mm <= range.near_mm) range.far_mm = range.near_mm + 1;
  return range;
}

Result<std::vector<std::uint8_t>> PhotographPreview(const ImageRgb& photograph, int max_side_px) {
  return report::EncodePng(report::ShrinkToFit(photograph, max_side_px, max_side_px));
}

Result<std::vector<std::uint8_t>> DepthPreview(const Surface& surface, std::optional<DepthRange> range,
                                               int max_side_px) {
  if (auto drawable = CheckDrawable(surface); !drawable) return Fail(drawable.error());
  if (!range) {
    auto robust = RobustDepthRange(surface);
    if (!robust) return Fail(robust.error());
    range = *robust;
  }
  if (!(range->far_mm > range->near_mm)) {
    return Fail(ErrorCode::kUsage, "the depth range is empty; give the nearer depth first");
  }
  // The bar is a fixed share of the picture, so that its letters stay readable when the picture is scaled down.
  const double scale = max_side_px / 320.0;
  const int bar_px = static_cast<int>(std::lround(kBarWidth * scale));
  const Cells cells = Average(surface, CutOf(surface), max_side_px - bar_px, max_side_px);
  const int map_width = cells.count.width();
  const int height = std::max(cells.count.height(), static_cast<int>(110 * scale));
  ImageRgb picture(map_width + bar_px, height, kWhite);
  for (int y = 0; y < cells.count.height(); ++y) {
    for (int x = 0; x < map_width; ++x) {
      if (cells.count(x, y) == 0) continue;
      const double depth = cells.mean_point(x, y).z();
      picture(x, y) = Viridis((range->far_mm - depth) / (range->far_mm - range->near_mm));
    }
  }
  Paste(ColourBar({range->near_mm, range->far_mm, "mm", true}, height, scale), map_width, 0, picture);
  return report::EncodePng(picture);
}

Result<std::vector<std::uint8_t>> ShadedPreview(const Surface& surface, int max_side_px) {
  if (auto drawable = CheckDrawable(surface); !drawable) return Fail(drawable.error());
  const Cells cells = Average(surface, CutOf(surface), max_side_px, max_side_px);
  const Eigen::Vector3f to_light = Eigen::Vector3f(-0.5F, -0.6F, -0.75F).normalized();
  ImageRgb picture(cells.count.width(), cells.count.height(), kWhite);
  for (int y = 0; y + 1 < picture.height(); ++y) {
    for (int x = 0; x + 1 < picture.width(); ++x) {
      if (cells.count(x, y) == 0 || cells.count(x + 1, y) == 0 || cells.count(x, y + 1) == 0) continue;
      const Eigen::Vector3f right = cells.mean_point(x + 1, y) - cells.mean_point(x, y);
      const Eigen::Vector3f down = cells.mean_point(x, y + 1) - cells.mean_point(x, y);
      // right x down points away from the camera (x right, y down, z away).
      const Eigen::Vector3f normal = down.cross(right).normalized();
      const float light = 0.18F + 0.82F * std::max(0.0F, normal.dot(to_light));
      const auto grey = [&](float level) {
        return static_cast<std::uint8_t>(std::lround(std::min(255.0F, level * light)));
      };
      picture(x, y) = {grey(238), grey(230), grey(220)};
    }
  }
  return report::EncodePng(picture);
}

}  // namespace striae::app
