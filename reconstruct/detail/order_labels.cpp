#include "reconstruct/detail/order_labels.h"

#include <algorithm>
#include <numeric>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {

std::vector<int> ApplyLabels(const Grid& grid, const Image<std::int32_t>& cell_label,
                             const std::vector<std::int32_t>& sheet_of_label,
                             const std::vector<std::int32_t>& sheet_of_region, PhaseResult& phase) {
  Unwrapped& unwrapped = phase.unwrapped;
  const std::size_t labels = sheet_of_label.size();
  // Sheets with one label need no look at the cells.
  std::vector<std::int32_t> first_of_sheet, labels_of_sheet;
  for (std::size_t i = 0; i < labels; ++i) {
    const auto sheet = static_cast<std::size_t>(sheet_of_label[i]);
    if (first_of_sheet.size() <= sheet) {
      first_of_sheet.resize(sheet + 1, kNone);
      labels_of_sheet.resize(sheet + 1, 0);
    }
    if (first_of_sheet[sheet] == kNone) first_of_sheet[sheet] = static_cast<std::int32_t>(i);
    ++labels_of_sheet[sheet];
  }
  const auto label_of = [&](int x, int y, std::int32_t sheet) {
    const int col = std::min(x / grid.cell_x, grid.width - 1), row = std::min(y / grid.cell_y, grid.height - 1);
    for (const auto& [dx, dy] : {Cell(0, 0), Cell(1, 0), Cell(-1, 0), Cell(0, 1), Cell(0, -1), Cell(1, 1), Cell(-1, 1),
                                 Cell(1, -1), Cell(-1, -1)}) {
      if (!cell_label.Contains(col + dx, row + dy)) continue;
      const std::int32_t label = cell_label(col + dx, row + dy);
      if (label >= 0 && sheet_of_label[static_cast<std::size_t>(label)] == sheet) return label;
    }
    return first_of_sheet[static_cast<std::size_t>(sheet)];
  };
  const int width = phase.mask.width(), height = phase.mask.height();
  std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(ThreadCount()));
  ParallelBlocks(height, [&](int thread, int first, int last) {
    auto& count = counts[static_cast<std::size_t>(thread)];
    count.resize(labels, 0);
    for (int y = first; y < last; ++y) {
      std::int32_t* r = unwrapped.region.Row(y);
      // Pixels of one region in one cell have one label.
      std::int32_t region = kNone, label = kNone;
      for (int x = 0, cell_end = 0; x < width; ++x) {
        if (x == cell_end) region = kNone, cell_end += grid.cell_x;
        if (r[x] < 0) continue;
        if (r[x] != region) {
          region = r[x];
          const std::int32_t sheet = sheet_of_region[static_cast<std::size_t>(region)];
          label = labels_of_sheet[static_cast<std::size_t>(sheet)] > 1
                      ? label_of(x, y, sheet)
                      : first_of_sheet[static_cast<std::size_t>(sheet)];
        }
        r[x] = label;
        ++count[static_cast<std::size_t>(label)];
      }
    }
  });
  std::vector<std::size_t> points(labels, 0);
  for (const auto& count : counts) {
    for (std::size_t i = 0; i < count.size(); ++i) points[i] += count[i];
  }
  std::vector<std::size_t> by_size(labels);
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) { return points[a] > points[b]; });
  std::vector<int> region_of_label(labels);
  unwrapped.pixels.assign(labels, 0);
  for (std::size_t i = 0; i < labels; ++i) {
    region_of_label[by_size[i]] = static_cast<int>(i);
    unwrapped.pixels[i] = points[by_size[i]];
  }
  const bool in_order = std::is_sorted(by_size.begin(), by_size.end());
  ParallelLines(in_order ? 0 : height, [&](int y) {
    std::int32_t* r = unwrapped.region.Row(y);
    for (int x = 0; x < width; ++x) r[x] = r[x] < 0 ? kNone : region_of_label[static_cast<std::size_t>(r[x])];
  });
  while (!unwrapped.pixels.empty() && unwrapped.pixels.back() == 0) unwrapped.pixels.pop_back();
  unwrapped.regions = static_cast<int>(unwrapped.pixels.size());
  return region_of_label;
}

}  // namespace striae::reconstruct::detail
