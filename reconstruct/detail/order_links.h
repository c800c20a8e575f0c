// What the light between two parts says about their whole numbers.
#pragma once

#include <vector>

#include "reconstruct/detail/order_parts.h"

namespace striae::reconstruct::detail {

/// Lines along which light goes on from one part to another without a gap, and those where it does not.
struct LitLines {
  std::size_t lit = 0, unlit = 0;
  LitLines& operator+=(const LitLines& other) {
    lit += other.lit;
    unlit += other.unlit;
    return *this;
  }
  /// Enough of them, a third of a stripe apart, and most agree.
  [[nodiscard]] bool Proven() const {
    constexpr std::size_t kFewest = 8;
    constexpr double kMost = 0.65;
    return lit >= kFewest && static_cast<double>(lit) >= kMost * static_cast<double>(lit + unlit);
  }
};

/// Two parts that meet along lines across the stripes, `from` on the projector's side.
/// Going away from the projector no surface can fall back unlit ground unseen: what lies behind the edge of something
/// nearer is in its shadow, whose width is the step in stripes. So where light goes on without a gap, `to` is level
/// with `from` or nearer by whole stripes. Across a shadow the light sheet goes on: its order is the same on both
/// sides.
struct Link {
  int from = 0, to = 0;
  LitLines lines;       ///< proven: light goes on, the true order of `to` is not farther than phase shows it
  bool shadow = false;  ///< unlit ground lies between, and `step` is known
  int step = 0;         ///< add to the offset of `from` to have that of `to`, by the shadow
  double alike = 0;     ///< share of the shadow's lines that say so
};

/// Unlit ground along one line, within one part or between two.
struct Gap {
  int from = 0, to = 0;     ///< parts
  int line = 0;             ///< of the grid
  int last = 0, first = 0;  ///< cells on either side of it
  int step = 0;             ///< as Link's
};

struct Lighting {
  std::vector<Link> links;
  std::vector<Gap> gaps;
};

/// `away` is +1 where shadows fall towards growing rows (columns, for vertical stripes), -1 the other way.
Lighting ReadLighting(const Grid& grid, const Mask& sound, const Parts& parts, const PhaseResult& phase,
                      const ImageRgb& picture, int away);

}  // namespace striae::reconstruct::detail
