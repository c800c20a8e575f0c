#include "reconstruct/verify/detail/region.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace striae::reconstruct::detail {
namespace {

struct Pixel {
  std::int64_t col = 0, row = 0;
};

std::int64_t Turn(const Pixel& a, const Pixel& b, const Pixel& c) {
  return (b.col - a.col) * (c.row - a.row) - (b.row - a.row) * (c.col - a.col);
}

/// One side of the hull (Andrew's monotone chain) of pixels in order of their rows.
std::vector<Pixel> Chain(const std::vector<Pixel>& pixels, int side) {
  std::vector<Pixel> chain;
  for (const Pixel& p : pixels) {
    while (chain.size() >= 2 && side * Turn(chain[chain.size() - 2], chain.back(), p) >= 0) chain.pop_back();
    chain.push_back(p);
  }
  return chain;
}

/// Where a side of the hull crosses each row.
void Fill(const std::vector<Pixel>& chain, std::vector<double>& border) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Pixel &a = chain[i - 1], &b = chain[i];
    for (std::int64_t row = a.row; row <= b.row; ++row) {
      const double share = b.row == a.row ? 0 : static_cast<double>(row - a.row) / static_cast<double>(b.row - a.row);
      border[static_cast<std::size_t>(row)] = static_cast<double>(a.col) + share * static_cast<double>(b.col - a.col);
    }
  }
}

}  // namespace

Result<Points> InOutline(const Surface& surface, const Outline& outline) {
  if (!surface.HasGrid()) {
    return Fail(ErrorCode::kBadFile,
                "the surface does not say which pixel each point came from, so an outline cannot "
                "be used; take the PLY that 'striae reconstruct' wrote");
  }
  Points inside;
  for (std::uint32_t i = 0; i < surface.size(); ++i) {
    if (Inside(outline.polygon_px, {static_cast<double>(surface.col[i]), static_cast<double>(surface.row[i])})) {
      inside.push_back(i);
    }
  }
  if (inside.size() < kFewestPoints) {
    return Fail(ErrorCode::kOutlineOffSurface, "the outline holds " + std::to_string(inside.size()) +
                                                   " points of the surface, too few; outline the artefact in sensor "
                                                   "pixels of this photograph");
  }
  return inside;
}

Points Thin(const Points& points, std::size_t count) {
  if (points.size() <= count) return points;
  Points thin(count);
  for (std::size_t i = 0; i < count; ++i) thin[i] = points[i * points.size() / count];
  return thin;
}

Points LargestConnected(const Surface& surface, const Points& points) {
  if (!surface.HasGrid()) return points;
  constexpr std::int32_t kNone = -1, kFree = -2;
  Image<std::int32_t> part(surface.sensor_width_px, surface.sensor_height_px, kNone);
  for (const std::uint32_t i : points) part(surface.col[i], surface.row[i]) = kFree;
  std::int32_t parts = 0, best = 0;
  std::size_t largest = 0;
  std::vector<Pixel> open;
  for (const std::uint32_t i : points) {
    if (part(surface.col[i], surface.row[i]) != kFree) continue;
    std::size_t size = 0;
    open.assign(1, {surface.col[i], surface.row[i]});
    part(surface.col[i], surface.row[i]) = parts;
    while (!open.empty()) {
      const Pixel p = open.back();
      open.pop_back();
      ++size;
      for (const Pixel& n : {Pixel{p.col + 1, p.row}, {p.col - 1, p.row}, {p.col, p.row + 1}, {p.col, p.row - 1}}) {
        const int col = static_cast<int>(n.col), row = static_cast<int>(n.row);
        if (!part.Contains(col, row) || part(col, row) != kFree) continue;
        part(col, row) = parts;
        open.push_back(n);
      }
    }
    if (size > largest) {
      largest = size;
      best = parts;
    }
    ++parts;
  }
  Points kept;
  for (const std::uint32_t i : points) {
    if (part(surface.col[i], surface.row[i]) == best) kept.push_back(i);
  }
  return kept;
}

Points InHullOf(const Surface& surface, const Points& points) {
  if (!surface.HasGrid() || points.empty()) return points;
  std::vector<Pixel> pixels;
  for (const std::uint32_t i : points) pixels.push_back({surface.col[i], surface.row[i]});
  std::sort(pixels.begin(), pixels.end(),
            [](const Pixel& a, const Pixel& b) { return a.row != b.row ? a.row < b.row : a.col < b.col; });
  const auto rows = static_cast<std::size_t>(surface.sensor_height_px);
  std::vector<double> left(rows, INFINITY), right(rows, -INFINITY);
  // The left side of the hull runs through the first pixels of the rows, the right side through the last ones.
  std::vector<Pixel> firsts, lasts;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i == 0 || pixels[i].row != pixels[i - 1].row) firsts.push_back(pixels[i]);
    if (i + 1 == pixels.size() || pixels[i].row != pixels[i + 1].row) lasts.push_back(pixels[i]);
  }
  Fill(Chain(firsts, 1), left);
  Fill(Chain(lasts, -1), right);
  if (firsts.size() == 1) {
    left[static_cast<std::size_t>(firsts[0].row)] = static_cast<double>(firsts[0].col);
    right[static_cast<std::size_t>(lasts[0].row)] = static_cast<double>(lasts[0].col);
  }
  Points inside;
  for (std::uint32_t i = 0; i < surface.size(); ++i) {
    const double col = surface.col[i];
    if (col >= left[surface.row[i]] && col <= right[surface.row[i]]) inside.push_back(i);
  }
  return inside;
}

std::uint32_t Draw::Below(std::size_t bound) {
  // SplitMix64 (Steele, Lea and Flood 2014).
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return static_cast<std::uint32_t>((z ^ (z >> 31U)) % bound);
}

std::vector<std::size_t> Kept(const std::vector<double>& deviations, double share) {
  std::vector<std::size_t> order(deviations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rejected = static_cast<std::size_t>(share * static_cast<double>(deviations.size()));
  const auto keep = static_cast<std::ptrdiff_t>(deviations.size() - rejected);
  std::nth_element(order.begin(), order.begin() + std::max<std::ptrdiff_t>(keep - 1, 0), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     const double da = std::abs(deviations[a]), db = std::abs(deviations[b]);
                     return da != db ? da < db : a < b;
                   });
  order.resize(static_cast<std::size_t>(keep));
  std::sort(order.begin(), order.end());
  return order;
}

double RangeOf(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double SdOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / n);
}

}  // namespace striae::reconstruct::detail
