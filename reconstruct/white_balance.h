// White balance of a surface's colours, in linear light.
#pragma once

#include <optional>
#include <string_view>

#include "core/result.h"
#include "core/surface.h"

namespace striae::reconstruct {

struct WhiteBalance {
  enum class Kind {
    kAsShot,      ///< as the photograph has it
    kGreyWorld,   ///< the surface's mean is grey
    kWhitePatch,  ///< its brightest hundredth is white in hue
    kGreyCard,    ///< what lies at (col, row) is grey
  };
  Kind kind = Kind::kAsShot;
  int col = 0, row = 0;  ///< kGreyCard: sensor pixel
};

/// "as-shot", "grey-world", "white-patch" or "grey-card=COL,ROW"; kUsage otherwise.
Result<WhiteBalance> WhiteBalanceFrom(std::string_view text);

struct WhiteGains {
  double red = 1, green = 1, blue = 1;  ///< factors in linear light that keep the reference's luminance (Rec. 709)
};

/// Changes surface.colour and returns the factors. The grey card is the mean of the points within 20 pixels.
/// kMeasurementRefused where the card has no points (or the surface none), is black, or would need a factor beyond 4.
Result<WhiteGains> Balance(const WhiteBalance& balance, Surface& surface);

}  // namespace striae::reconstruct
