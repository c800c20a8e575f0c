#include "reconstruct/detail/order_seams.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace striae::reconstruct::detail {

void GiveSeams(const std::vector<bool>& warned, LabelledCells& cells) {
  const Grid& grid = cells.grid;
  auto& sheet_of_label = cells.sheet_of_label;
  auto& orders = cells.orders;
  constexpr int kReach = 6;  // cells: a stripe across, two along
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> seam_of;
  const auto taker = [&](std::int32_t own, std::int32_t other) {
    const auto o = static_cast<std::size_t>(other);
    if (o >= warned.size() || warned[o]) return other;
    const auto [found, is_new] = seam_of.emplace(std::minmax(own, other), static_cast<std::int32_t>(orders.size()));
    if (is_new) {
      RegionOrder seam = orders[static_cast<std::size_t>(own)];
      seam.source = OrderSource::kBridge;
      seam.margin = 0;
      seam.warning = "two surfaces whole stripes apart meet here, and the light of both is mixed";
      orders.push_back(std::move(seam));
      sheet_of_label.push_back(sheet_of_label[static_cast<std::size_t>(own)]);
    }
    return found->second;
  };
  std::vector<std::tuple<int, int, std::int32_t>> now, next;
  const auto silent = [&](std::int32_t label) {
    return label >= 0 && static_cast<std::size_t>(label) < warned.size() && !warned[static_cast<std::size_t>(label)];
  };
  for (int step = 0; step < kReach; ++step) {
    next.clear();
    const auto take = [&](int x, int y) {
      const std::int32_t own = cells.label(x, y);
      if (!silent(own)) return;
      ForNeighbours(grid, {x, y}, [&](int nx, int ny) {
        const std::int32_t other = cells.label(nx, ny);
        if (other < 0 || other == own) return;
        if (sheet_of_label[static_cast<std::size_t>(other)] != sheet_of_label[static_cast<std::size_t>(own)]) return;
        if (orders[static_cast<std::size_t>(other)].source == OrderSource::kNone) return;
        next.emplace_back(x, y, taker(own, other));
      });
    };
    if (step == 0) {
      for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) take(x, y);
      }
    } else {
      for (const auto& [x, y, label] : now) ForNeighbours(grid, {x, y}, take);
    }
    for (const auto& [x, y, label] : next) cells.label(x, y) = label;
    now.swap(next);
  }
}

bool DoubtShadows(const std::vector<Gap>& gaps, int away, bool horizontal, LabelledCells& cells) {
  const Grid& grid = cells.grid;
  auto& sheet_of_label = cells.sheet_of_label;
  auto& orders = cells.orders;
  constexpr int kFewestLines = 8, kMargin = 2;
  std::map<std::int32_t, std::set<int>> lines;
  std::map<std::int32_t, std::vector<const Gap*>> of_label;
  for (const Gap& gap : gaps) {
    const auto from = static_cast<std::size_t>(gap.from), to = static_cast<std::size_t>(gap.to);
    if (!orders[from].warning.empty() || sheet_of_label[from] != sheet_of_label[to]) continue;
    if (orders[to].offset - orders[from].offset == gap.step || gap.step == 0) continue;
    lines[gap.from].insert(gap.line);
    of_label[gap.from].push_back(&gap);
  }
  bool found = false;
  const int last_line = (horizontal ? grid.width : grid.height) - 1, length = horizontal ? grid.height : grid.width;
  for (const auto& [label, on] : lines) {
    if (static_cast<int>(on.size()) < kFewestLines) continue;
    found = true;
    RegionOrder doubted = orders[static_cast<std::size_t>(label)];
    doubted.source = OrderSource::kBridge;
    doubted.margin = std::min(doubted.margin, 0.5);
    doubted.warning =
        "a shadow falls beyond it that only a step by whole stripes would cast: it may stand nearer by that; look for "
        "steps in depth that should not be there";
    const auto own = static_cast<std::int32_t>(orders.size());
    orders.push_back(std::move(doubted));
    sheet_of_label.push_back(sheet_of_label[static_cast<std::size_t>(label)]);
    for (const Gap* gap : of_label[label]) {
      for (int line = std::max(0, gap->line - kMargin); line <= std::min(last_line, gap->line + kMargin); ++line) {
        for (int at = gap->last; at >= 0 && at < length; at -= away) {
          std::int32_t& cell = horizontal ? cells.label(line, at) : cells.label(at, line);
          if (cell == label) cell = own;
        }
      }
    }
  }
  return found;
}

}  // namespace striae::reconstruct::detail
