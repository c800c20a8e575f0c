// The light of the photograph along one line across the stripes.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "reconstruct/detail/order_cells.h"

namespace striae::reconstruct::detail {

/// A dark stretch of a line.
struct Dark {
  double orders = 0;   ///< by which the phase goes on across it, less the stripes in it
  double stripes = 0;  ///< its length over the carrier's period
  double light = 0;    ///< its mean, against the bright stripes beside it
  /// Whole stripes that are missing: between two bright ones half a stripe is dark anyway, and where the edge of a
  /// shadow cuts a bright one, nothing is.
  [[nodiscard]] int Missing() const { return static_cast<int>(std::floor(orders + 0.25)); }
};

/// Lines are those of the grid, across the stripes; places on them are pixels of the photograph.
class LineLight {
 public:
  LineLight(const Grid& grid, const PhaseResult& phase, const ImageRgb& picture);

  /// The dark stretch between two cells over which the phase goes on most. Between two bright stripes that is half a
  /// stripe, however steep or dark the surface; in the shadow of a step by k stripes no light falls over k more.
  /// Nothing where no light falls beside it, or no order is known.
  [[nodiscard]] std::optional<Dark> LongestDark(int line, int low, int high) const;

 private:
  /// Light from a cell of a line to another one and a stripe and a half beyond either.
  struct Profile {
    std::vector<double> light;
    int first = 0;          ///< pixel of the line
    int low = 0, high = 0;  ///< the two cells in it
  };
  [[nodiscard]] bool InPicture(int pixel) const;
  [[nodiscard]] int Middle(int line) const;
  [[nodiscard]] double PhaseAt(int line, int pixel) const;
  [[nodiscard]] std::int32_t SheetAt(int line, int pixel) const;
  [[nodiscard]] double Light(int line, int pixel) const;
  [[nodiscard]] Profile LightBetween(int line, int low, int high) const;
  [[nodiscard]] double OrderAt(int line, int pixel, int inwards) const;
  [[nodiscard]] double CleanOrderAt(int line, int pixel, int into) const;
  [[nodiscard]] int DimStripes(int line, const Profile& p, int first, int last) const;

  const Grid& grid_;
  const Unwrapped& unwrapped_;
  const ImageRgb& picture_;
  std::array<double, 256> decoded_;
  double period_;
  bool horizontal_;
  double light_noise_;  ///< sd of Light
};

}  // namespace striae::reconstruct::detail
