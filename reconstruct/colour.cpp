#include "reconstruct/colour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

using detail::ParallelBlocks;
using detail::ParallelLines;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kBrightHalfWidth = 0.1F;  // stripes around a bright centre that give the colour

struct Crest {
  int first = 0, last = 0;  ///< pixels within kBrightHalfWidth of a whole order
  float r = 0, g = 0, b = 0;
};

/// The bright centres along one line, in order.
std::vector<Crest> CrestsOf(const Rgb8* colour, const float* order, int length) {
  std::vector<Crest> crests;
  float whole_before = kNone;
  int count = 0;
  for (int x = 0; x < length; ++x) {
    const float whole = std::nearbyint(order[x]);
    if (std::isnan(order[x]) || std::abs(order[x] - whole) > kBrightHalfWidth) continue;
    if (crests.empty() || whole != whole_before || x - crests.back().last > 3) {
      crests.push_back({x, x, 0, 0, 0});
      count = 0;
    }
    whole_before = whole;
    Crest& crest = crests.back();
    crest.last = x;
    ++count;
    const auto mix = [&](float& mean, std::uint8_t value) {
      mean += (static_cast<float>(value) - mean) / static_cast<float>(count);
    };
    mix(crest.r, colour[x].r);
    mix(crest.g, colour[x].g);
    mix(crest.b, colour[x].b);
  }
  return crests;
}

void FillLine(const float* order, int length, Rgb8* colour) {
  const std::vector<Crest> crests = CrestsOf(colour, order, length);
  if (crests.empty()) return;
  const auto center = [](const Crest& c) { return 0.5F * static_cast<float>(c.first + c.last); };
  std::size_t next = 0;
  for (int x = 0; x < length; ++x) {
    if (std::isnan(order[x])) continue;
    const auto at = static_cast<float>(x);
    while (next < crests.size() && center(crests[next]) < at) ++next;
    const Crest& after = crests[std::min(next, crests.size() - 1)];
    const Crest& before = crests[next == 0 ? 0 : next - 1];
    const float span = center(after) - center(before);
    const float t = span > 0 ? std::clamp((at - center(before)) / span, 0.0F, 1.0F) : 0.0F;
    const auto blend = [t](float a, float b) { return static_cast<std::uint8_t>(std::lround(a + t * (b - a))); };
    colour[x] = {blend(before.r, after.r), blend(before.g, after.g), blend(before.b, after.b)};
  }
}

}  // namespace

ImageRgb ColourWithoutStripes(const ImageRgb& photograph, const ImageF& order, StripeDirection direction) {
  ImageRgb out = photograph;
  const int height = out.height();
  if (direction == StripeDirection::kVertical) {
    ParallelLines(height, [&](int row) { FillLine(order.Row(row), out.width(), out.Row(row)); });
    return out;
  }
  // A few columns at a time are turned into lines and back.
  ParallelBlocks(out.width(), [&](int, int first, int last) {
    ImageRgb colours(height, last - first);
    ImageF orders(height, last - first);
    for (int row = 0; row < height; ++row) {
      for (int col = first; col < last; ++col) {
        colours(row, col - first) = out(col, row);
        orders(row, col - first) = order(col, row);
      }
    }
    for (int line = 0; line < last - first; ++line) FillLine(orders.Row(line), height, colours.Row(line));
    for (int row = 0; row < height; ++row) {
      for (int col = first; col < last; ++col) out(col, row) = colours(row, col - first);
    }
  });
  return out;
}

}  // namespace striae::reconstruct
