#include "reconstruct/detail/order_parting.h"

#include <map>
#include <numeric>
#include <tuple>

#include "reconstruct/detail/order_labels.h"
#include "reconstruct/detail/order_merge.h"
#include "reconstruct/detail/order_seams.h"
#include "reconstruct/detail/order_sound.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kNeck = 1.6;          ///< stripes from either side of a neck
constexpr int kFarthest = 24;          ///< cells from a seed: four stripes across, eight along
constexpr double kLeastShare = 0.004;  ///< of all points: smaller parts are not split off
constexpr double kSliver = 0.4;        ///< stripes from either side of what is no more than a sliver
constexpr double kLeastRest = 0.0005;  ///< the same, of what hangs on a part by less than a neck

}  // namespace

Parting::Parting(const PhaseResult& phase, const ImageRgb& picture, int away)
    : grid_(phase),
      sound_(1, 1, 0),
      regions_(phase.unwrapped.regions),
      away_(away),
      horizontal_(phase.direction == StripeDirection::kHorizontal) {
  if (grid_.width < 3 || grid_.height < 3) return;
  const double period = phase.carrier_period_px;
  sound_ = SoundCells(grid_, grid_.Cells(horizontal_ ? 1.0 : 1.5, period, grid_.cell_x),
                      grid_.Cells(horizontal_ ? 1.5 : 1.0, period, grid_.cell_y));
  TakeOutBends(grid_, grid_.Cells(horizontal_ ? 0.66 : 1.0, period, grid_.cell_x),
               grid_.Cells(horizontal_ ? 1.0 : 0.66, period, grid_.cell_y), horizontal_, sound_);
  const Mask eroded =
      Eroded(grid_, sound_, grid_.Cells(kNeck, period, grid_.cell_x), grid_.Cells(kNeck, period, grid_.cell_y));
  Parts parts(grid_, sound_, eroded);
  const auto points =
      std::count_if(grid_.region.pixels().begin(), grid_.region.pixels().end(), [](std::int32_t r) { return r >= 0; });
  parts.KeepLarge(eroded, kLeastShare * static_cast<double>(points));
  parts.Grow(kFarthest);
  parts.FillRest(
      Eroded(grid_, sound_, grid_.Cells(kSliver, period, grid_.cell_x), grid_.Cells(kSliver, period, grid_.cell_y)),
      kLeastRest * static_cast<double>(points));
  lighting_ = ReadLighting(grid_, sound_, parts, phase, picture, away);
  label_ = std::move(parts.part);
  sheet_ = std::move(parts.parent);
  MergeProven();
}

/// Parts that are one get one label; labels are numbered anew from 0 on, without holes, and the photograph's regions
/// that the grid has no cell of come last.
void Parting::MergeProven() {
  const auto merged = MergedParts(sheet_, lighting_.links);
  std::vector<std::int32_t> number(sheet_.size(), kNone), sheet;
  std::vector<bool> seen(static_cast<std::size_t>(regions_), false);
  for (const std::int32_t label : label_.pixels()) {
    if (label < 0) continue;
    const auto part = static_cast<std::size_t>(merged[static_cast<std::size_t>(label)]);
    if (number[part] != kNone) continue;
    number[part] = static_cast<std::int32_t>(sheet.size());
    sheet.push_back(sheet_[part]);
    seen[static_cast<std::size_t>(sheet_[part])] = true;
  }
  for (std::size_t r = 0; r < seen.size(); ++r) {
    if (!seen[r]) sheet.push_back(static_cast<std::int32_t>(r));
  }
  sheet_ = std::move(sheet);
  const auto renumber = [&](std::int32_t& label) {
    label = number[static_cast<std::size_t>(merged[static_cast<std::size_t>(label)])];
  };
  for (std::int32_t& label : label_.pixels()) {
    if (label >= 0) renumber(label);
  }
  for (Link& link : lighting_.links) renumber(link.from), renumber(link.to);
  std::erase_if(lighting_.links, [](const Link& link) { return link.from == link.to; });
  for (Gap& gap : lighting_.gaps) renumber(gap.from), renumber(gap.to);
}

void Parting::Part(PhaseResult& phase) {
  sheets_.resize(static_cast<std::size_t>(regions_));
  std::iota(sheets_.begin(), sheets_.end(), 0);
  std::vector<std::int32_t> whole(sheets_.begin(), sheets_.end());
  std::vector<int> region(sheet_.size());
  if (static_cast<int>(sheet_.size()) > regions_) {
    region = ApplyLabels(grid_, label_, sheet_, whole, phase);
    sheets_.assign(sheet_.size(), 0);
    for (std::size_t i = 0; i < sheet_.size(); ++i) sheets_[static_cast<std::size_t>(region[i])] = sheet_[i];
    sheets_.resize(static_cast<std::size_t>(phase.unwrapped.regions));
  } else {
    for (std::size_t i = 0; i < sheet_.size(); ++i) region[i] = sheet_[i];
  }
  // From here on a cell's label is its region.
  const auto of = [&](int label) { return region[static_cast<std::size_t>(label)]; };
  for (std::int32_t& label : label_.pixels()) {
    if (label >= 0) label = of(label);
  }
  sheet_.assign(sheets_.begin(), sheets_.end());
  links_ = lighting_.links;
  for (Link& link : links_) link.from = of(link.from), link.to = of(link.to);
  for (Gap& gap : lighting_.gaps) gap.from = of(gap.from), gap.to = of(gap.to);
}

void Parting::Join(PhaseResult& phase, std::vector<RegionOrder>& orders) {
  if (sheet_.empty()) return;
  // One label for what is of one sheet, has one number and is equally warned of.
  std::map<std::tuple<std::int32_t, bool, bool, int>, std::int32_t> group;
  std::vector<std::int32_t> label_of_region(orders.size()), sheet_of_label;
  std::vector<RegionOrder> joined;
  std::vector<bool> warned;
  for (std::size_t r = 0; r < orders.size(); ++r) {
    const bool is_warned = !orders[r].warning.empty(), none = orders[r].source == OrderSource::kNone;
    const auto [found, is_new] = group.emplace(std::tuple(sheet_[r], is_warned, none, none ? 0 : orders[r].offset),
                                               static_cast<std::int32_t>(joined.size()));
    label_of_region[r] = found->second;
    if (is_new) {
      joined.push_back(orders[r]);
      sheet_of_label.push_back(sheet_[r]);
      warned.push_back(is_warned);
      continue;
    }
    RegionOrder& sum = joined[static_cast<std::size_t>(found->second)];
    sum.margin = std::min(sum.margin, orders[r].margin);
  }
  const std::size_t whole = joined.size();
  for (std::int32_t& label : label_.pixels()) {
    if (label >= 0) label = label_of_region[static_cast<std::size_t>(label)];
  }
  for (Gap& gap : lighting_.gaps) {
    gap.from = label_of_region[static_cast<std::size_t>(gap.from)];
    gap.to = label_of_region[static_cast<std::size_t>(gap.to)];
  }
  LabelledCells cells{grid_, label_, sheet_of_label, joined};
  if (whole > 1) GiveSeams(warned, cells);
  const bool shadowed = DoubtShadows(lighting_.gaps, away_, horizontal_, cells);
  if (whole == orders.size() && joined.size() == whole && !shadowed && whole == static_cast<std::size_t>(regions_))
    return;
  const std::vector<std::int32_t> sheet_of_region = sheet_;
  const auto region = ApplyLabels(grid_, label_, sheet_of_label, sheet_of_region, phase);
  orders.assign(static_cast<std::size_t>(phase.unwrapped.regions), {});
  for (std::size_t i = 0; i < joined.size(); ++i) {
    const auto r = static_cast<std::size_t>(region[i]);
    if (r >= orders.size()) continue;
    joined[i].points = phase.unwrapped.pixels[r];
    orders[r] = std::move(joined[i]);
  }
}

}  // namespace striae::reconstruct::detail
