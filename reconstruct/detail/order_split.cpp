// Regions that unwrapping may have joined across a step of the surface.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/order.h"

namespace striae::reconstruct {
namespace {

constexpr float kValley = 0.87F;  ///< of the amplitude on either side
constexpr float kSureNoises = 4;  ///< and by so many noises below it
constexpr float kBend = 0.09F;    ///< stripes: second difference over a stripe across, two thirds along
constexpr double kShadow = 0.7;   ///< stripes of missing light: a step of a whole stripe hides a whole stripe's width
constexpr std::size_t kFewestLines = 12;  ///< of the grid, for a word on shadows
constexpr double kNeck = 1.6;             ///< stripes from either side of a neck
constexpr double kLeastShare = 0.004;     ///< of all points: smaller parts are not split off
constexpr std::int32_t kNone = -1;

/// The picture in cells of a sixth of a stripe across and a third along the stripes.
class Grid {
 public:
  explicit Grid(const PhaseResult& phase) {
    const bool horizontal = phase.direction == StripeDirection::kHorizontal;
    const int fine = std::max(1, static_cast<int>(std::lround(phase.carrier_period_px / 6))),
              coarse = std::max(2, static_cast<int>(std::lround(phase.carrier_period_px / 3)));
    cell_x = horizontal ? coarse : fine;
    cell_y = horizontal ? fine : coarse;
    width = phase.mask.width() / cell_x;
    height = phase.mask.height() / cell_y;
    region = Image<std::int32_t>::Unset(width, height);
    amplitude = ImageF::Unset(width, height);
    order = ImageF::Unset(width, height);
    const int averaged = std::min(cell_x, 4);
    detail::ParallelLines(height, [&](int row) {
      const int y = row * cell_y + cell_y / 2;
      const std::int32_t* r = phase.unwrapped.region.Row(y);
      const float *a = phase.amplitude.Row(y), *p = phase.unwrapped.phase.Row(y);
      for (int col = 0; col < width; ++col) {
        const int x = col * cell_x;
        region(col, row) = r[x + cell_x / 2];
        order(col, row) = p[x + cell_x / 2] / (2 * std::numbers::pi_v<float>);
        amplitude(col, row) = std::accumulate(a + x, a + x + averaged, 0.0F) / static_cast<float>(averaged);
      }
    });
    noise = static_cast<float>(phase.noise / std::sqrt(averaged));
    order_noise = static_cast<float>(phase.noise / (2 * std::numbers::pi));
  }
  [[nodiscard]] int Cells(double stripes, double period_px, int cell) const {
    return std::max(1, static_cast<int>(std::lround(stripes * period_px / cell)));
  }

  int cell_x = 1, cell_y = 1, width = 0, height = 0;
  float noise = 0;        ///< of the amplitude
  float order_noise = 0;  ///< times the amplitude, stripes
  Image<std::int32_t> region;
  ImageF amplitude;
  ImageF order;  ///< stripes; NaN outside of the regions
};

/// The largest of the `reach` values before each of the `count` ones (not itself), `stride` apart.
void LargestBefore(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = k; i < count; ++i) largest[i] = std::max(largest[i], values[i - k]);
  }
}
void LargestAfter(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = 0; i + k < count; ++i) largest[i] = std::max(largest[i], values[i + k]);
  }
}

/// 1 where the cell is of a region and not in a valley.
Mask SoundCells(const Grid& grid, int reach_x, int reach_y) {
  Mask sound(grid.width, grid.height, 0);
  const auto is_valley = [&](float at, float before, float after) {
    const float least = std::min(before, after);
    return at < kValley * least && least - at > kSureNoises * grid.noise;
  };
  detail::ParallelBlocks(grid.height, [&](int, int first, int last) {
    const auto width = static_cast<std::size_t>(grid.width);
    std::vector<float> before(width), after(width);
    for (int row = first; row < last; ++row) {
      const float* a = grid.amplitude.Row(row);
      LargestBefore(a, grid.width, reach_x, before.data());
      LargestAfter(a, grid.width, reach_x, after.data());
      std::uint8_t* to = sound.Row(row);
      for (int x = 0; x < grid.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        to[x] = grid.region(x, row) >= 0 && !is_valley(a[x], before[i], after[i]) ? 1 : 0;
      }
      std::fill(before.begin(), before.end(), 0.0F);
      std::fill(after.begin(), after.end(), 0.0F);
      for (int k = 1; k <= reach_y; ++k) {
        if (row - k >= 0) {
          const float* up = grid.amplitude.Row(row - k);
          for (std::size_t x = 0; x < width; ++x) before[x] = std::max(before[x], up[x]);
        }
        if (row + k < grid.height) {
          const float* down = grid.amplitude.Row(row + k);
          for (std::size_t x = 0; x < width; ++x) after[x] = std::max(after[x], down[x]);
        }
      }
      for (int x = 0; x < grid.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        if (is_valley(a[x], before[i], after[i])) to[x] = 0;
      }
    }
  });
  return sound;
}

/// Takes out the cells where the order is bent: the slope changes along the outline of what lies before.
void TakeOutBends(const Grid& grid, int lag_x, int lag_y, Mask& sound) {
  constexpr float kSecondDifference = 2.45F;  // root of 1 + 4 + 1
  detail::ParallelLines(grid.height, [&](int row) {
    std::uint8_t* to = sound.Row(row);
    const std::int32_t* r = grid.region.Row(row);
    const float *at = grid.order.Row(row), *a = grid.amplitude.Row(row);
    const auto judge = [&](int x, float bend) {
      if (bend > kBend && bend * a[x] > kSureNoises * kSecondDifference * grid.order_noise) to[x] = 0;
    };
    for (int x = lag_x; x + lag_x < grid.width; ++x) {
      if (r[x] >= 0 && r[x - lag_x] == r[x] && r[x + lag_x] == r[x])
        judge(x, std::abs(at[x - lag_x] - 2 * at[x] + at[x + lag_x]));
    }
    if (row < lag_y || row + lag_y >= grid.height) return;
    const std::int32_t *ru = grid.region.Row(row - lag_y), *rd = grid.region.Row(row + lag_y);
    const float *up = grid.order.Row(row - lag_y), *down = grid.order.Row(row + lag_y);
    for (int x = 0; x < grid.width; ++x) {
      if (r[x] >= 0 && ru[x] == r[x] && rd[x] == r[x]) judge(x, std::abs(up[x] - 2 * at[x] + down[x]));
    }
  });
}

/// Cells with no unsound one, and no other region's, within the rectangle around them; beyond the picture is sound.
Mask Eroded(const Grid& grid, const Mask& sound, int reach_x, int reach_y) {
  Mask narrow(grid.width, grid.height, 0), eroded(grid.width, grid.height, 0);
  detail::ParallelBlocks(grid.height, [&](int, int first, int last) {
    std::vector<int> before(static_cast<std::size_t>(grid.width));  // sound cells of its region that end here
    for (int row = first; row < last; ++row) {
      const std::uint8_t* s = sound.Row(row);
      const std::int32_t* r = grid.region.Row(row);
      int run = reach_x;
      for (int x = 0; x < grid.width; ++x) {
        run = s[x] == 0 ? 0 : (x > 0 && r[x] != r[x - 1] ? 1 : run + 1);
        before[static_cast<std::size_t>(x)] = run;
      }
      run = reach_x;
      for (int x = grid.width - 1; x >= 0; --x) {
        run = s[x] == 0 ? 0 : (x + 1 < grid.width && r[x] != r[x + 1] ? 1 : run + 1);
        narrow(x, row) = run > reach_x && before[static_cast<std::size_t>(x)] > reach_x ? 1 : 0;
      }
    }
  });
  detail::ParallelLines(grid.height, [&](int row) {
    std::uint8_t* to = eroded.Row(row);
    const std::uint8_t* own = narrow.Row(row);
    std::copy(own, own + grid.width, to);
    for (int y = std::max(0, row - reach_y); y <= std::min(grid.height - 1, row + reach_y); ++y) {
      const std::uint8_t* from = narrow.Row(y);
      const std::int32_t *r = grid.region.Row(y), *r0 = grid.region.Row(row);
      for (int x = 0; x < grid.width; ++x) to[x] = static_cast<std::uint8_t>(to[x] & from[x] & (r[x] == r0[x] ? 1 : 0));
    }
  });
  return eroded;
}

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

/// 1 for cells of a valley beside another part of the same region: both surfaces mix there.
Mask Seams(const Grid& grid, const Mask& sound, const Parts& parts) {
  Mask seam(grid.width, grid.height, 0);
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      const std::int32_t own = parts.part(col, row);
      if (own == kNone || sound(col, row) != 0) continue;
      for (int y = std::max(0, row - 1); y <= std::min(grid.height - 1, row + 1); ++y) {
        for (int x = std::max(0, col - 1); x <= std::min(grid.width - 1, col + 1); ++x) {
          const std::int32_t p = parts.part(x, y);
          if (p != kNone && p != own && grid.region(x, y) == grid.region(col, row)) seam(col, row) = 1;
        }
      }
    }
  }
  return seam;
}

/// Gives every pixel its part's number (regions that stay whole keep theirs), takes out the seams, numbers by size.
std::vector<int> Relabel(const Grid& grid, const Parts& parts, const Mask& seam, PhaseResult& phase) {
  Unwrapped& unwrapped = phase.unwrapped;
  std::vector<int> origin(static_cast<std::size_t>(unwrapped.regions));
  std::iota(origin.begin(), origin.end(), 0);
  // The first part of a region keeps the region's number; the others get new ones.
  std::vector<std::int32_t> number(parts.parent.size(), kNone);
  std::vector<bool> split(origin.size(), false);
  for (const std::int32_t p : parts.part.pixels()) {
    if (p < 0 || number[static_cast<std::size_t>(p)] != kNone) continue;
    const auto region = static_cast<std::size_t>(parts.parent[static_cast<std::size_t>(p)]);
    number[static_cast<std::size_t>(p)] =
        split[region] ? static_cast<std::int32_t>(origin.size()) : parts.parent[static_cast<std::size_t>(p)];
    if (split[region]) origin.push_back(static_cast<int>(region));
    split[region] = true;
  }
  const auto part_of = [&](int x, int y, std::int32_t region) {
    const int col = std::min(x / grid.cell_x, grid.width - 1), row = std::min(y / grid.cell_y, grid.height - 1);
    for (const auto& [dx, dy] : {Cell(0, 0), Cell(1, 0), Cell(-1, 0), Cell(0, 1), Cell(0, -1), Cell(1, 1), Cell(-1, 1),
                                 Cell(1, -1), Cell(-1, -1)}) {
      if (!parts.part.Contains(col + dx, row + dy)) continue;
      const std::int32_t p = parts.part(col + dx, row + dy);
      if (p >= 0 && parts.parent[static_cast<std::size_t>(p)] == region) return number[static_cast<std::size_t>(p)];
    }
    return region;
  };
  const int width = phase.mask.width(), height = phase.mask.height();
  std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(detail::ThreadCount()));
  detail::ParallelBlocks(height, [&](int thread, int first, int last) {
    auto& count = counts[static_cast<std::size_t>(thread)];
    count.resize(origin.size(), 0);
    for (int y = first; y < last; ++y) {
      std::int32_t* r = unwrapped.region.Row(y);
      for (int x = 0; x < width; ++x) {
        if (r[x] < 0) continue;
        if (split[static_cast<std::size_t>(r[x])]) {
          if (seam(std::min(x / grid.cell_x, grid.width - 1), std::min(y / grid.cell_y, grid.height - 1)) != 0) {
            r[x] = kNone;
            phase.mask(x, y) = 0;
            unwrapped.phase(x, y) = std::numeric_limits<float>::quiet_NaN();
            continue;
          }
          r[x] = part_of(x, y, r[x]);
        }
        ++count[static_cast<std::size_t>(r[x])];
      }
    }
  });
  std::vector<std::size_t> points(origin.size(), 0);
  for (const auto& count : counts) {
    for (std::size_t i = 0; i < count.size(); ++i) points[i] += count[i];
  }
  std::vector<std::size_t> by_size(origin.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) { return points[a] > points[b]; });
  std::vector<std::int32_t> rank(origin.size());
  std::vector<int> parents(origin.size());
  unwrapped.pixels.assign(origin.size(), 0);
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    rank[by_size[i]] = static_cast<std::int32_t>(i);
    parents[i] = origin[by_size[i]];
    unwrapped.pixels[i] = points[by_size[i]];
  }
  detail::ParallelLines(height, [&](int y) {
    std::int32_t* r = unwrapped.region.Row(y);
    for (int x = 0; x < width; ++x) r[x] = r[x] < 0 ? kNone : rank[static_cast<std::size_t>(r[x])];
  });
  unwrapped.regions = static_cast<int>(origin.size());
  return parents;
}

}  // namespace

std::vector<int> SplitDoubtfulRegions(PhaseResult& phase) {
  std::vector<int> whole(static_cast<std::size_t>(phase.unwrapped.regions));
  std::iota(whole.begin(), whole.end(), 0);
  const Grid grid(phase);
  const double period = phase.carrier_period_px;
  if (grid.width < 3 || grid.height < 3) return whole;
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  Mask sound = SoundCells(grid, grid.Cells(horizontal ? 1.0 : 1.5, period, grid.cell_x),
                          grid.Cells(horizontal ? 1.5 : 1.0, period, grid.cell_y));
  TakeOutBends(grid, grid.Cells(horizontal ? 0.66 : 1.0, period, grid.cell_x),
               grid.Cells(horizontal ? 1.0 : 0.66, period, grid.cell_y), sound);
  const Mask eroded =
      Eroded(grid, sound, grid.Cells(kNeck, period, grid.cell_x), grid.Cells(kNeck, period, grid.cell_y));
  Parts parts(grid, sound, eroded);
  parts.Grow();
  const auto points =
      std::count_if(grid.region.pixels().begin(), grid.region.pixels().end(), [](std::int32_t r) { return r >= 0; });
  if (!parts.KeepLarge(eroded, kLeastShare * static_cast<double>(points))) return whole;
  parts.Grow();
  Joiner(grid, phase, sound, parts).Join();
  return Relabel(grid, parts, Seams(grid, sound, parts), phase);
}

}  // namespace striae::reconstruct
