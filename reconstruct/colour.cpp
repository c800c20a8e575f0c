#include "reconstruct/colour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/line_block.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

constexpr float kBrightHalfWidth = 0.1F;  // stripes around a bright centre that give the colour
constexpr float kStep = 0.25F;            // stripes between neighbours: another surface

/// Nearest whole number without a call: adding 1.5 * 2^23 leaves no bits for the fraction.
float Whole(float value) {
  constexpr float kMagic = 12582912.0F;
  return (value + kMagic) - kMagic;
}

struct Colour {
  float r = 0, g = 0, b = 0;
};

std::uint8_t Byte(float value) { return static_cast<std::uint8_t>(value + 0.5F); }

/// One line across the stripes, pixel after pixel. What is written lies behind what is still to be read, so that a line
/// is changed in its place; `stride` pixels lie between neighbours of the line.
class LineFiller {
 public:
  void Start(Rgb8* line, std::ptrdiff_t stride) {
    *this = {};
    line_ = line;
    stride_ = stride;
  }

  void Take(int x, float order) {
    if (!(std::abs(order - previous_) < kStep)) {  // true for NaN too
      End(x);
      if (std::isnan(order)) {
        previous_ = order;
        return;
      }
      written_ = x;
      within_ = true;
    }
    previous_ = order;
    const float whole = Whole(order);
    if (std::abs(order - whole) <= kBrightHalfWidth) {
      if (count_ > 0 && whole != whole_) CloseCrest();
      if (count_ == 0) first_ = x;
      whole_ = whole;
      Add(x);
    } else if (count_ > 0) {
      CloseCrest();
    }
  }

  /// The piece of surface ends before pixel x.
  void End(int x) {
    if (!within_) return;
    if (count_ > 0) CloseCrest();
    if (has_before_) {
      for (; written_ < x; ++written_) Put(written_, before_);
    }
    has_before_ = within_ = false;
  }

 private:
  void Add(int x) {
    const Rgb8 c = line_[x * stride_];
    sum_.r += static_cast<float>(c.r);
    sum_.g += static_cast<float>(c.g);
    sum_.b += static_cast<float>(c.b);
    ++count_;
    last_ = x;
  }

  void CloseCrest() {
    const float share = 1 / static_cast<float>(count_);
    const Colour mean{sum_.r * share, sum_.g * share, sum_.b * share};
    const float center = 0.5F * static_cast<float>(first_ + last_);
    const int until = static_cast<int>(center) + 1;
    if (!has_before_) {
      for (; written_ < until; ++written_) Put(written_, mean);
    } else {
      const float per_pixel = 1 / (center - before_center_);
      for (; written_ < until; ++written_) {
        const float t = (static_cast<float>(written_) - before_center_) * per_pixel;
        Put(written_, {before_.r + t * (mean.r - before_.r), before_.g + t * (mean.g - before_.g),
                       before_.b + t * (mean.b - before_.b)});
      }
    }
    before_ = mean;
    before_center_ = center;
    has_before_ = true;
    sum_ = {};
    count_ = 0;
  }

  void Put(int x, const Colour& c) { line_[x * stride_] = {Byte(c.r), Byte(c.g), Byte(c.b)}; }

  Rgb8* line_ = nullptr;
  std::ptrdiff_t stride_ = 1;
  float previous_ = std::numeric_limits<float>::quiet_NaN();  ///< order of the pixel before
  float whole_ = 0;                                           ///< order of the open crest
  Colour sum_;                                                ///< of the open crest
  int count_ = 0, first_ = 0, last_ = 0;
  Colour before_;  ///< the crest before, in the same piece of surface
  float before_center_ = 0;
  bool has_before_ = false, within_ = false;
  int written_ = 0;  ///< pixels of the piece before this one have their colour
};

}  // namespace

ImageRgb ColourWithoutStripes(ImageRgb photograph, const ImageF& order, StripeDirection direction) {
  ImageRgb out = std::move(photograph);
  const int width = out.width(), height = out.height();
  if (direction == StripeDirection::kVertical) {
    detail::ParallelLines(height, [&](int row) {
      LineFiller filler;
      filler.Start(out.Row(row), 1);
      for (int col = 0; col < width; ++col) filler.Take(col, order(col, row));
      filler.End(width);
    });
    return out;
  }
  // Neighbouring columns go down together: rows are read as they lie in memory, and what is written lies close by.
  constexpr int kColumns = 128, kAhead = 6;
  detail::ParallelBlocks(
      width,
      [&](int, int first, int last) {
        std::vector<LineFiller> fillers(static_cast<std::size_t>(last - first));
        for (int col = first; col < last; ++col) {
          fillers[static_cast<std::size_t>(col - first)].Start(out.Row(0) + col, width);
        }
        detail::Extent before;  // what has no order in this row and had none in the row before is as it was
        for (int row = 0; row < height; ++row) {
          const float* orders = order.Row(row) + first;
          detail::PrefetchRow(order, row + kAhead, first, last);
          const detail::Extent extent = detail::ExtentOf(orders, last - first);
          const int from = std::min(extent.first, before.empty() ? extent.first : before.first);
          const int to = std::max(extent.last, before.last);
          for (int k = from; k < to; ++k) fillers[static_cast<std::size_t>(k)].Take(row, orders[k]);
          before = extent;
        }
        for (LineFiller& filler : fillers) filler.End(height);
      },
      kColumns);
  return out;
}

}  // namespace striae::reconstruct
