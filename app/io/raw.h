// Raw files (NEF of the D90, DNG) -> photograph in linear light, through LibRaw.
#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"
#include "core/result.h"

namespace striae::app {

/// Luminance is linear light (Photograph::linear): black level taken off, white balance as shot, no gamma, no
/// brightening, no rotation. Bilinear interpolation of the colour filter array, the same everywhere: cleverer ones
/// choose a direction per pixel and bend the stripes' phase. 1 where any channel of the sensor is full.
/// The geometry is that of the camera's own JPEG: the sensor gives some pixels more on every side, which are cut at the
/// place where the JPEG embedded in the file fits, in the middle for a D90's file without one.
/// kBadImage for damaged or truncated files.
Result<Photograph> DecodeRaw(std::span<const std::uint8_t> bytes);

/// Where `part` lies in `whole` (its upper left pixel; col, row), by correlation of their gradients; both encoded
/// alike. False when `part` is larger, more than 128 pixels smaller, or fits nowhere.
struct Offset {
  int col = 0, row = 0;
};
bool FindPart(const ImageF& whole, const ImageF& part, Offset& offset);

}  // namespace striae::app
