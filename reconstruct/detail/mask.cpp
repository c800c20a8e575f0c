#include "reconstruct/detail/mask.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// One step of a separable 3 x 3 erosion (and = true) or dilation.
Mask Morphed(const Mask& mask, bool erode) {
  const int width = mask.width(), height = mask.height();
  Mask across(width, height), out(width, height);
  const auto combine = [erode](int a, int b, int c) {
    return static_cast<std::uint8_t>(erode ? (a & b & c) : (a | b | c));
  };
  ParallelLines(height, [&](int row) {
    const std::uint8_t* in = mask.Row(row);
    std::uint8_t* to = across.Row(row);
    for (int x = 0; x < width; ++x) to[x] = combine(in[std::max(0, x - 1)], in[x], in[std::min(width - 1, x + 1)]);
  });
  ParallelLines(height, [&](int row) {
    const std::uint8_t *up = across.Row(std::max(0, row - 1)), *at = across.Row(row),
                       *down = across.Row(std::min(height - 1, row + 1));
    std::uint8_t* to = out.Row(row);
    for (int x = 0; x < width; ++x) to[x] = combine(up[x], at[x], down[x]);
  });
  return out;
}

/// Flood fill from a seed; returns the pixels reached and marks them with 2.
void Collect(Mask& mask, int seed, std::vector<int>& pixels) {
  const int width = mask.width(), count = static_cast<int>(mask.size());
  auto& m = mask.pixels();
  pixels.assign(1, seed);
  m[static_cast<std::size_t>(seed)] = 2;
  for (std::size_t next = 0; next < pixels.size(); ++next) {
    const int at = pixels[next], col = at % width;
    const int neighbours[4] = {col > 0 ? at - 1 : -1, col + 1 < width ? at + 1 : -1, at - width,
                               at + width < count ? at + width : -1};
    for (const int to : neighbours) {
      if (to < 0 || m[static_cast<std::size_t>(to)] != 1) continue;
      m[static_cast<std::size_t>(to)] = 2;
      pixels.push_back(to);
    }
  }
}

}  // namespace

ImageF LineMaximum(const ImageF& lines, int before, int after) {
  const int width = lines.width();
  ImageF out(width, lines.height());
  ParallelLines(lines.height(), [&](int line) {
    const float* in = lines.Row(line);
    float* to = out.Row(line);
    std::vector<int> falling;  // indices of candidates, their values falling
    std::size_t head = 0;
    for (int x = 0; x < width + after; ++x) {
      if (x < width) {
        while (falling.size() > head && in[falling.back()] <= in[x]) falling.pop_back();
        falling.push_back(x);
      }
      const int center = x - after;
      if (center < 0) continue;
      while (falling[head] < center - before) ++head;
      to[center] = in[falling[head]];
    }
  });
  return out;
}

void CleanMask(Mask& mask, int least_px) {
  mask = Morphed(Morphed(mask, true), false);
  std::vector<int> pixels;
  for (int i = 0; i < static_cast<int>(mask.size()); ++i) {
    if (mask.pixels()[static_cast<std::size_t>(i)] != 1) continue;
    Collect(mask, i, pixels);
    if (static_cast<int>(pixels.size()) >= least_px) continue;
    for (const int pixel : pixels) mask.pixels()[static_cast<std::size_t>(pixel)] = 0;
  }
  for (std::uint8_t& m : mask.pixels()) m = m != 0 ? 1 : 0;
}

void CutSteps(const ImageF& wrapped, Mask& mask, float largest) {
  const int width = wrapped.width(), height = wrapped.height();
  const auto wrap = [](float d) {
    constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
    return d - kTwoPi * std::nearbyint(d / kTwoPi);
  };
  ParallelLines(height, [&](int row) {
    if (row == 0 || row == height - 1) return;
    const float *up = wrapped.Row(row - 1), *at = wrapped.Row(row), *down = wrapped.Row(row + 1);
    std::uint8_t* m = mask.Row(row);
    for (int x = 1; x + 1 < width; ++x) {
      if (m[x] == 0) continue;
      const float h = wrap(at[x - 1] - at[x]) - wrap(at[x] - at[x + 1]);
      const float v = wrap(up[x] - at[x]) - wrap(at[x] - down[x]);
      if (std::abs(h) > largest || std::abs(v) > largest) m[x] = 0;
    }
  });
}

}  // namespace striae::reconstruct::detail
