// Parts of regions, and whether the light at their joints lets them be one surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "reconstruct/detail/order_cells.h"

namespace striae::reconstruct::detail {

constexpr double kShadow = 0.7;  ///< stripes of missing light: a step of a whole stripe hides a whole stripe's width
constexpr std::size_t kFewestLines = 12;  ///< of the grid, for a word on shadows
constexpr std::int32_t kNone = -1;

using Cell = std::pair<int, int>;

/// Calls visit(col, row) for the four neighbours within the grid.
template <typename Visit>
void ForNeighbours(const Grid& grid, const Cell& at, const Visit& visit) {
  const auto [x, y] = at;
  if (x > 0) visit(x - 1, y);
  if (x + 1 < grid.width) visit(x + 1, y);
  if (y > 0) visit(x, y - 1);
  if (y + 1 < grid.height) visit(x, y + 1);
}

/// Connected parts of the eroded cells, and what they are grown to within their regions.
class Parts {
 public:
  Parts(const Grid& grid, const Mask& sound, const Mask& eroded) : grid_(grid), sound_(sound) {
    part = Image<std::int32_t>(grid.width, grid.height, kNone);
    for (int row = 0; row < grid.height; ++row) {
      for (int col = 0; col < grid.width; ++col) {
        if (eroded(col, row) != 0 && part(col, row) == kNone) Flood(eroded, {col, row});
      }
    }
  }

  /// Over the sound cells first, so that parts meet in the valleys between them; then over all of the region.
  void Grow() {
    std::vector<Cell> now, next;
    for (const bool valleys : {false, true}) {
      now.clear();
      for (int row = 0; row < grid_.height; ++row) {
        for (int col = 0; col < grid_.width; ++col) {
          if (part(col, row) != kNone && OnRim({col, row})) now.emplace_back(col, row);
        }
      }
      while (!now.empty()) {
        next.clear();
        for (const Cell& cell : now) {
          const std::int32_t own = part(cell.first, cell.second);
          ForNeighbours(grid_, cell, [&](int x, int y) {
            if (part(x, y) != kNone || grid_.region(x, y) != parent[static_cast<std::size_t>(own)]) return;
            if (!valleys && sound_(x, y) == 0) return;
            part(x, y) = own;
            next.emplace_back(x, y);
          });
        }
        now.swap(next);
      }
    }
  }

  /// Leaves only the seeds of parts that are grown to at least `least` cells; false when no region has two.
  bool KeepLarge(const Mask& eroded, double least) {
    std::vector<std::size_t> cells(parent.size(), 0);
    for (const std::int32_t p : part.pixels()) {
      if (p >= 0) ++cells[static_cast<std::size_t>(p)];
    }
    std::vector<int> large_in_region;
    std::vector<bool> keep(parent.size());
    for (std::size_t p = 0; p < parent.size(); ++p) {
      keep[p] = static_cast<double>(cells[p]) >= least;
      const auto region = static_cast<std::size_t>(parent[p]);
      if (large_in_region.size() <= region) large_in_region.resize(region + 1, 0);
      if (keep[p]) ++large_in_region[region];
    }
    if (std::none_of(large_in_region.begin(), large_in_region.end(), [](int n) { return n > 1; })) return false;
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        std::int32_t& p = part(col, row);
        if (p == kNone) continue;
        const auto i = static_cast<std::size_t>(p);
        if (eroded(col, row) == 0 || !keep[i] || large_in_region[static_cast<std::size_t>(parent[i])] < 2) p = kNone;
      }
    }
    return true;
  }

  Image<std::int32_t> part;
  std::vector<std::int32_t> parent;  ///< region of each part

 private:
  void Flood(const Mask& eroded, const Cell& first) {
    const auto id = static_cast<std::int32_t>(parent.size());
    const std::int32_t region = grid_.region(first.first, first.second);
    parent.push_back(region);
    std::vector<Cell> open{first};
    part(first.first, first.second) = id;
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      ForNeighbours(grid_, cell, [&](int x, int y) {
        if (eroded(x, y) == 0 || part(x, y) != kNone || grid_.region(x, y) != region) return;
        part(x, y) = id;
        open.emplace_back(x, y);
      });
    }
  }
  [[nodiscard]] bool OnRim(const Cell& cell) const {
    bool rim = false;
    ForNeighbours(grid_, cell, [&](int x, int y) { rim = rim || part(x, y) == kNone; });
    return rim;
  }

  const Grid& grid_;
  const Mask& sound_;
};

/// Light that is missing across the joints of two parts, in stripes, along lines across the stripes: with the lower
/// number at the small orders, and the other way round.
struct Joint {
  std::vector<double> forwards, backwards;
};

/// A step by whole stripes hides as many stripes' width from the light, on the lower side of what lies before (the
/// projector is above), the stripes on both sides being in step there: smoothed or not, the integral of the missing
/// amplitude is the shadow's width. Two parts that meet both ways round without room for a shadow are one surface.
class Joiner {
 public:
  Joiner(const Grid& grid, const PhaseResult& phase, const Mask& sound, Parts& parts)
      : grid_(grid), sound_(sound), parts_(parts), horizontal_(phase.direction == StripeDirection::kHorizontal) {
    cell_ = (horizontal_ ? grid.cell_y : grid.cell_x) / phase.carrier_period_px;
  }

  void Join() {
    const int lines = horizontal_ ? grid_.width : grid_.height;
    for (int line = 0; line < lines; ++line) ReadLine(line);
    std::vector<std::int32_t> to(parts_.parent.size());
    std::iota(to.begin(), to.end(), 0);
    const auto root = [&](std::int32_t p) {
      while (to[static_cast<std::size_t>(p)] != p) p = to[static_cast<std::size_t>(p)];
      return p;
    };
    for (auto& [pair, joint] : joints_) {
      if (!Lit(joint.forwards) || !Lit(joint.backwards)) continue;
      const std::int32_t a = root(pair.first), b = root(pair.second);
      to[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
    for (std::int32_t& p : parts_.part.pixels()) {
      if (p >= 0) p = root(p);
    }
  }

 private:
  [[nodiscard]] static bool Lit(std::vector<double>& missing) {
    if (missing.size() < kFewestLines) return false;
    const auto middle = missing.begin() + static_cast<long>(missing.size() / 2);
    std::nth_element(missing.begin(), middle, missing.end());
    return *middle < kShadow;
  }

  /// Between the last sound cell of one part and the first of another one of the same region.
  void ReadLine(int line) {
    const int length = horizontal_ ? grid_.height : grid_.width, furthest = static_cast<int>(3 / cell_);
    int last = -1;
    for (int at = 0; at < length; ++at) {
      const std::int32_t part = Part(line, at);
      if (part == kNone || At(sound_, line, at) == 0) continue;
      if (last >= 0 && at - last <= furthest && Part(line, last) != part) Read(line, last, at);
      last = at;
    }
  }

  void Read(int line, int from, int to) {
    const std::int32_t a = Part(line, from), b = Part(line, to);
    if (parts_.parent[static_cast<std::size_t>(a)] != parts_.parent[static_cast<std::size_t>(b)]) return;
    // What the amplitude falls from: the largest within a stripe on either side.
    const int reach = static_cast<int>(std::lround(1 / cell_)), length = horizontal_ ? grid_.height : grid_.width;
    float before = 0, after = 0;
    for (int k = 0; k <= reach; ++k) {
      if (from - k >= 0) before = std::max(before, At(grid_.amplitude, line, from - k));
      if (to + k < length) after = std::max(after, At(grid_.amplitude, line, to + k));
    }
    double missing = 0;
    for (int at = std::max(0, from - reach); at <= std::min(length - 1, to + reach); ++at) {
      const double share = std::clamp(static_cast<double>(at - from) / std::max(1, to - from), 0.0, 1.0);
      const double level = (1 - share) * before + share * after;
      if (level > 0) missing += std::clamp(1 - At(grid_.amplitude, line, at) / level, 0.0, 1.0) * cell_;
    }
    Joint& joint = joints_[std::minmax(a, b)];
    (a < b ? joint.forwards : joint.backwards).push_back(missing);
  }

  template <typename T>
  [[nodiscard]] T At(const Image<T>& image, int line, int at) const {
    return horizontal_ ? image(line, at) : image(at, line);
  }
  [[nodiscard]] std::int32_t Part(int line, int at) const { return At(parts_.part, line, at); }

  const Grid& grid_;
  const Mask& sound_;
  Parts& parts_;
  bool horizontal_;
  double cell_ = 0;  ///< stripes
  std::map<std::pair<std::int32_t, std::int32_t>, Joint> joints_;
};

}  // namespace striae::reconstruct::detail
