// Regions parted where a step of whole stripes may hide, and put together again where it is shown that none does.
#pragma once

#include <cstdint>
#include <vector>

#include "reconstruct/detail/order_links.h"
#include "reconstruct/order.h"

namespace striae::reconstruct::detail {

class Parting {
 public:
  /// Reads the picture; changes nothing. `away`: see ReadLighting.
  Parting(const PhaseResult& phase, const ImageRgb& picture, int away);

  /// Makes every part that stays doubtful a region of its own. Nothing when there is none.
  void Part(PhaseResult& phase);

  /// Of each region, after Part: regions with the same number were one sheet when they were unwrapped.
  [[nodiscard]] const std::vector<int>& sheets() const { return sheets_; }
  /// Between regions, after Part.
  [[nodiscard]] const std::vector<Link>& links() const { return links_; }

  /// After the orders of the regions are settled: puts together what was one sheet and has one number again, gives the
  /// seam beside what is warned of to it, and makes what lies before the shadows that the order does not know of a
  /// region of its own, with a warning.
  void Join(PhaseResult& phase, std::vector<RegionOrder>& orders);

 private:
  void MergeProven();

  Grid grid_;
  Mask sound_;
  Image<std::int32_t> label_;        ///< of each cell
  std::vector<std::int32_t> sheet_;  ///< of each label
  Lighting lighting_;
  int regions_ = 0;  ///< of the photograph as it was unwrapped
  int away_ = 1;
  bool horizontal_ = true;
  std::vector<int> sheets_;
  std::vector<Link> links_;
};

}  // namespace striae::reconstruct::detail
