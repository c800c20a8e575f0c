// Parts of regions: connected ground where the order cannot have slipped by a whole stripe unseen.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "reconstruct/detail/order_cells.h"

namespace striae::reconstruct::detail {

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
  Parts(const Grid& grid, Mask& sound, const Mask& eroded) : grid_(grid), sound_(sound) {
    part = Image<std::int32_t>(grid.width, grid.height, kNone);
    for (int row = 0; row < grid.height; ++row) {
      for (int col = 0; col < grid.width; ++col) {
        if (eroded(col, row) != 0 && part(col, row) == kNone) Flood(eroded, {col, row});
      }
    }
  }

  /// Over the sound cells first, so that parts meet in the valleys between them; then over all of the region. No
  /// farther than `steps` cells each: what is so far from any seed hangs on it by less than a neck.
  void Grow(int steps) {
    std::vector<Cell> now, next;
    for (const bool valleys : {false, true}) {
      now = Front([&](int x, int y) { return (sound_(x, y) == 0) == valleys; });
      for (int step = 0; step < steps && !now.empty(); ++step) {
        next.clear();
        for (const Cell& cell : now) {
          const std::int32_t own = part(cell.first, cell.second);
          ForNeighbours(grid_, cell, [&](int x, int y) {
            if (part(x, y) != kNone || grid_.region(x, y) != parent[static_cast<std::size_t>(own)]) return;
            if ((sound_(x, y) == 0) != valleys) return;
            part(x, y) = own;
            next.emplace_back(x, y);
          });
        }
        now.swap(next);
      }
    }
  }

  /// Leaves only the seeds of parts that would grow to at least `least` cells.
  void KeepLarge(const Mask& eroded, double least) {
    std::vector<std::size_t> cells = Cells();
    if (std::all_of(cells.begin(), cells.end(), [&](std::size_t n) { return static_cast<double>(n) >= least; })) return;
    Grow(grid_.width + grid_.height);
    cells = Cells();
    std::vector<bool> keep(parent.size());
    for (std::size_t p = 0; p < parent.size(); ++p) keep[p] = static_cast<double>(cells[p]) >= least;
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        std::int32_t& p = part(col, row);
        if (p == kNone) continue;
        if (eroded(col, row) == 0 || !keep[static_cast<std::size_t>(p)]) p = kNone;
      }
    }
  }

  /// What no part has grown to: connected ground with `least` cells or more of `wide` is a part of its own, for what
  /// parts it from the others is a valley or a neck. Specks and slivers go to the part beside them, and with none
  /// beside to one part of their region; they are no sound ground: what light says there may be of either side.
  void FillRest(const Mask& wide, double least) {
    Mask rest(grid_.width, grid_.height, 0), speck(grid_.width, grid_.height, 0);
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col)
        rest(col, row) = grid_.region(col, row) >= 0 && part(col, row) == kNone ? 1 : 0;
    }
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        if (rest(col, row) == 0 || part(col, row) != kNone || speck(col, row) != 0) continue;
        const auto cells = Flood(rest, {col, row});
        const auto wide_cells =
            std::count_if(cells.begin(), cells.end(), [&](const Cell& c) { return wide(c.first, c.second) != 0; });
        if (static_cast<double>(wide_cells) >= least) continue;
        parent.pop_back();
        for (const auto& [x, y] : cells) part(x, y) = kNone, speck(x, y) = 1, sound_(x, y) = 0;
      }
    }
    std::vector<Cell> now = Front([&](int x, int y) { return speck(x, y) != 0; }), next;
    for (; !now.empty(); now.swap(next)) {
      next.clear();
      for (const Cell& cell : now) {
        const std::int32_t own = part(cell.first, cell.second);
        ForNeighbours(grid_, cell, [&](int x, int y) {
          if (speck(x, y) == 0 || part(x, y) != kNone || grid_.region(x, y) != parent[static_cast<std::size_t>(own)])
            return;
          part(x, y) = own;
          next.emplace_back(x, y);
        });
      }
    }
    std::vector<std::int32_t> whole;
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        const std::int32_t region = grid_.region(col, row);
        if (region < 0 || part(col, row) != kNone) continue;
        const auto r = static_cast<std::size_t>(region);
        if (whole.size() <= r) whole.resize(r + 1, kNone);
        if (whole[r] == kNone) {
          whole[r] = static_cast<std::int32_t>(parent.size());
          parent.push_back(region);
        }
        part(col, row) = whole[r];
      }
    }
  }

  Image<std::int32_t> part;
  std::vector<std::int32_t> parent;  ///< region of each part

 private:
  std::vector<Cell> Flood(const Mask& eroded, const Cell& first) {
    const auto id = static_cast<std::int32_t>(parent.size());
    const std::int32_t region = grid_.region(first.first, first.second);
    parent.push_back(region);
    std::vector<Cell> open{first};
    part(first.first, first.second) = id;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Cell cell = open[k];
      ForNeighbours(grid_, cell, [&](int x, int y) {
        if (eroded(x, y) == 0 || part(x, y) != kNone || grid_.region(x, y) != region) return;
        part(x, y) = id;
        open.emplace_back(x, y);
      });
    }
    return open;
  }
  [[nodiscard]] std::vector<std::size_t> Cells() const {
    std::vector<std::size_t> cells(parent.size(), 0);
    for (const std::int32_t p : part.pixels()) {
      if (p >= 0) ++cells[static_cast<std::size_t>(p)];
    }
    return cells;
  }

  /// Cells of parts, row by row, beside cells of none that are of the part's region and `open`.
  template <typename Open>
  [[nodiscard]] std::vector<Cell> Front(const Open& open) const {
    std::vector<Cell> front;
    for (int row = 0; row < grid_.height; ++row) {
      const std::int32_t *p = part.Row(row), *r = grid_.region.Row(row);
      for (int col = 0; col < grid_.width; ++col) {
        if (p[col] != kNone || r[col] < 0 || !open(col, row)) continue;
        ForNeighbours(grid_, {col, row}, [&](int x, int y) {
          if (part(x, y) != kNone && grid_.region(x, y) == r[col]) front.emplace_back(x, y);
        });
      }
    }
    const auto row_first = [](const Cell& a, const Cell& b) {
      return std::pair(a.second, a.first) < std::pair(b.second, b.first);
    };
    std::sort(front.begin(), front.end(), row_first);
    front.erase(std::unique(front.begin(), front.end()), front.end());
    return front;
  }

  const Grid& grid_;
  Mask& sound_;
};

}  // namespace striae::reconstruct::detail
