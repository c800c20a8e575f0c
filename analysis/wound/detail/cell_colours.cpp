#include "analysis/wound/detail/cell_colours.h"

#include <algorithm>
#include <cmath>

#include "core/srgb.h"

namespace striae::wound {
namespace {

using Light = std::array<double, 3>;  // linear

constexpr double kLuminance = 0.25;  // that all hues are brought to: L* 57
constexpr Light kToLuminance = {0.2126, 0.7152, 0.0722};

std::uint8_t Encoded(double light) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(SrgbFromLight(light), 0.0, 1.0)));
}

std::vector<Light> LightOfCells(const ImageRgb& photograph, const Patch& patch) {
  const std::array<double, 256> decoded = LightOfBytes();
  std::vector<Light> light(patch.size(), Light{0, 0, 0});
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      Light& sum = light[patch.At(i, j)];
      for (int r = 0; r < patch.bin_px; ++r) {
        for (int c = 0; c < patch.bin_px; ++c) {
          const int col = patch.col0_px + i * patch.bin_px + c, row = patch.row0_px + j * patch.bin_px + r;
          if (!photograph.Contains(col, row)) continue;
          const Rgb8 p = photograph(col, row);
          sum[0] += decoded[p.r];
          sum[1] += decoded[p.g];
          sum[2] += decoded[p.b];
        }
      }
    }
  }
  return light;
}

}  // namespace

CellColours ColoursOf(const Surface& surface, const Patch& patch) {
  std::vector<std::array<double, 4>> sums(patch.size(), {0, 0, 0, 0});
  for (std::size_t k = 0; k < surface.size(); ++k) {
    const int i = (surface.col[k] - patch.col0_px) / patch.bin_px, j = (surface.row[k] - patch.row0_px) / patch.bin_px;
    if (surface.col[k] < patch.col0_px || surface.row[k] < patch.row0_px || i >= patch.width || j >= patch.height)
      continue;
    auto& sum = sums[patch.At(i, j)];
    sum[0] += surface.colour[k].r;
    sum[1] += surface.colour[k].g;
    sum[2] += surface.colour[k].b;
    sum[3] += 1;
  }
  CellColours means(patch.size(), {0, 0, 0});
  for (std::size_t c = 0; c < patch.size(); ++c) {
    for (std::size_t k = 0; k < 3 && sums[c][3] > 0; ++k) {
      means[c][k] = static_cast<std::uint8_t>(std::lround(sums[c][k] / sums[c][3]));
    }
  }
  return means;
}

CellColours HuesOf(const ImageRgb& photograph, const Patch& patch) {
  const auto light = LightOfCells(photograph, patch);
  CellColours hues(patch.size(), {0, 0, 0});
  for (std::size_t c = 0; c < patch.size(); ++c) {
    double luminance = 0;
    for (std::size_t k = 0; k < 3; ++k) luminance += kToLuminance[k] * light[c][k];
    for (std::size_t k = 0; k < 3 && luminance > 0; ++k) hues[c][k] = Encoded(kLuminance * light[c][k] / luminance);
  }
  return hues;
}

std::vector<std::size_t> GiveToWound(const Patch& patch, double deep_mm, int reach_cells, std::vector<double>& depth_mm,
                                     CellColours& colours) {
  std::vector<std::size_t> front, given;
  std::vector<std::uint8_t> taken(patch.size());
  for (std::size_t c = 0; c < patch.size(); ++c) {
    taken[c] = patch.state[c] == Patch::kMissing ? 0 : 1;
    if (taken[c] != 0 && depth_mm[c] > deep_mm) front.push_back(c);
  }
  for (int step = 0; step < reach_cells && !front.empty(); ++step) {
    std::vector<std::size_t> next_front;
    for (const std::size_t c : front) {
      ForNeighbours(patch, c, [&](std::size_t next) {
        if (taken[next] != 0) return;
        taken[next] = 1;
        colours[next] = colours[c];
        depth_mm[next] = depth_mm[c];
        next_front.push_back(next);
      });
    }
    given.insert(given.end(), next_front.begin(), next_front.end());
    front = std::move(next_front);
  }
  return given;
}

}  // namespace striae::wound
