#include "reconstruct/detail/lateral.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/vector.h"
#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/line_block.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

constexpr int kCell = 16;
/// A pair's mean minus the pixel has sqrt(1.5) of the noise; beyond this many standard deviations it is shape.
constexpr float kLargest = 3.0F;

/// Adds |fourth difference| to sums[x / kCell], and 1 to counts, where all five pixels are there; `first` and `last`
/// are whole cells.
STRIAE_VECTORISED void AddFourthDifferences(const float* const pixels[5], int first, int last, float* sums,
                                            float* counts) {
  const float *a = pixels[0], *b = pixels[1], *c = pixels[2], *d = pixels[3], *e = pixels[4];
  for (int cell = first; cell < last; cell += kCell) {
    float sum[kCell], count[kCell];
    for (int k = 0; k < kCell; ++k) {
      const int x = cell + k;
      const float difference = std::abs(a[x] + e[x] - 4 * (b[x] + d[x]) + 6 * c[x]);
      const bool there = difference == difference;
      sum[k] = there ? difference : 0.0F;
      count[k] = there ? 1.0F : 0.0F;
    }
    for (int k = 0; k < kCell; ++k) sums[cell / kCell] += sum[k], counts[cell / kCell] += count[k];
  }
}

/// Weighted mean of `at` and the pairs (before[k], after[k]) that lie within `largest` of it.
STRIAE_VECTORISED void SmoothRow(const float* at, const float* const* before, const float* const* after,
                                 const std::vector<float>& kernel, const float* largest, int first, int last,
                                 float* sum, float* weight, float* out) {
  for (int x = first; x < last; ++x) sum[x] = 0, weight[x] = kernel[0];
  for (std::size_t k = 1; k < kernel.size(); ++k) {
    const float *b = before[k], *a = after[k];
    const float twice = 2 * kernel[k];
    for (int x = first; x < last; ++x) {
      const float difference = 0.5F * (b[x] + a[x]) - at[x];
      const float w = std::abs(difference) <= largest[x] ? twice : 0.0F;  // 0 for NaN
      sum[x] += w == 0.0F ? 0.0F : w * difference;
      weight[x] += w;
    }
  }
  for (int x = first; x < last; ++x) out[x] = at[x] + sum[x] / weight[x];
}

/// Rows of an image with neighbours along the stripe: in the row itself, or in other rows.
class Neighbours {
 public:
  Neighbours(const ImageF& image, bool along_rows, int reach) : image_(image), along_rows_(along_rows), reach_(reach) {}
  /// Pixels [first(), last()) of a row have all neighbours within reach; rows outside have none.
  [[nodiscard]] int first() const { return along_rows_ ? reach_ : 0; }
  [[nodiscard]] int last() const { return along_rows_ ? image_.width() - reach_ : image_.width(); }
  [[nodiscard]] bool Has(int row) const {
    return along_rows_ ? first() < last() : row >= reach_ && row + reach_ < image_.height();
  }
  /// `own` stands for the row itself, whose place in the image may be written already.
  [[nodiscard]] const float* At(const float* own, int row, int offset) const {
    return along_rows_ ? own + offset : image_.Row(row + offset);
  }

 private:
  const ImageF& image_;
  bool along_rows_;
  int reach_;
};

/// Largest difference that noise explains, for every cell of the image.
ImageF NoiseLimits(const ImageF& order, bool along_rows, int spacing) {
  constexpr float kGain = 8.3666F;          // sqrt(1 + 16 + 36 + 16 + 1): of white noise in a fourth difference
  constexpr float kMeanOfNormal = 0.7979F;  // mean of |x| over its standard deviation
  constexpr float kFewest = 24;
  const int columns = order.width() / kCell + 1, rows = order.height() / kCell + 1;
  ImageF limits(columns, rows, 0.0F);
  const Neighbours neighbours(order, along_rows, 2 * spacing);
  ParallelLines(rows, [&](int cell_row) {
    std::vector<float> counts(static_cast<std::size_t>(columns), 0.0F);
    float* sums = limits.Row(cell_row);
    for (int row = cell_row * kCell; row < std::min(order.height(), (cell_row + 1) * kCell); ++row) {
      if (!neighbours.Has(row)) continue;
      const float* own = order.Row(row);
      const float* pixels[5];
      for (int k = 0; k < 5; ++k) pixels[k] = neighbours.At(own, row, spacing * (k - 2));
      const Extent extent = ExtentOf(own, order.width());
      // Whole cells with all neighbours; what is left out at the ends has no noise, and stays as it is.
      const int first = (std::max(neighbours.first(), extent.first) + kCell - 1) / kCell * kCell;
      const int last = std::min(neighbours.last(), extent.last) / kCell * kCell;
      AddFourthDifferences(pixels, first, last, sums, counts.data());
    }
    for (int x = 0; x < columns; ++x) {
      const float count = counts[static_cast<std::size_t>(x)];
      const float noise = count >= kFewest ? sums[x] / count / (kGain * kMeanOfNormal) : 0.0F;
      sums[x] = kLargest * std::sqrt(1.5F) * noise;
    }
  });
  return limits;
}

}  // namespace

ImageF SmoothAlongStripes(ImageF order, StripeDirection direction, double sigma_px) {
  std::vector<float> kernel = GaussianKernel(sigma_px);
  // What lies beyond two and a half standard deviations weighs little and costs as much as the rest.
  kernel.resize(std::min(kernel.size(), static_cast<std::size_t>(2.5 * sigma_px) + 1));
  const int reach = static_cast<int>(kernel.size()) - 1, width = order.width();
  if (reach < 1) return order;
  const bool along_rows = direction == StripeDirection::kHorizontal;
  const int spacing = std::max(1, static_cast<int>(std::lround(sigma_px / 2)));
  const ImageF limits = NoiseLimits(order, along_rows, spacing);
  const Neighbours neighbours(order, along_rows, reach);
  ImageF apart = along_rows ? ImageF() : order;  // neighbours in other rows must be read before they are changed
  ParallelBlocks(order.height(), [&](int, int first, int last) {
    const auto count = static_cast<std::size_t>(width);
    std::vector<float> own(count), largest(count), sum(count), weight(count);
    std::vector<const float*> before(kernel.size()), after(kernel.size());
    for (int row = first; row < last; ++row) {
      if (!neighbours.Has(row)) continue;
      const Extent extent = ExtentOf(order.Row(row), width);
      const int from = std::max(extent.first, neighbours.first()), to = std::min(extent.last, neighbours.last());
      if (from >= to) continue;
      std::copy(order.Row(row) + extent.first - std::min(extent.first, reach),
                order.Row(row) + std::min(width, extent.last + reach),
                own.data() + extent.first - std::min(extent.first, reach));
      for (int x = from; x < to;) {  // cell by cell
        const int end = std::min(to, (x / kCell + 1) * kCell);
        std::fill(largest.begin() + x, largest.begin() + end, limits(x / kCell, row / kCell));
        x = end;
      }
      for (int k = 1; k <= reach; ++k) {
        before[static_cast<std::size_t>(k)] = neighbours.At(own.data(), row, -k);
        after[static_cast<std::size_t>(k)] = neighbours.At(own.data(), row, k);
      }
      SmoothRow(own.data(), before.data(), after.data(), kernel, largest.data(), from, to, sum.data(), weight.data(),
                along_rows ? order.Row(row) : apart.Row(row));
    }
  });
  return along_rows ? std::move(order) : std::move(apart);
}

}  // namespace striae::reconstruct::detail
