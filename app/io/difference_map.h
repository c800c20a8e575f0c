// The picture that `calibrate --map` writes: where the reconstructed surfaces differ from the reference object.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::app {

struct DifferencePanel {
  std::string title;  ///< printable ASCII
  ImageF map_mm;      ///< NaN where nothing was compared
};

/// PNG: one panel a photograph in a grid, blue = nearer to the camera than the reference, red = farther, one labelled
/// colour bar in mm at the right. The scale is the 98th percentile of the differences, rounded up to 1, 2 or 5; larger
/// ones take the end colours. kMeasurementRefused when there is nothing to draw; maps must have one size
/// (std::logic_error).
Result<std::vector<std::uint8_t>> DifferenceMap(const std::vector<DifferencePanel>& panels);

}  // namespace striae::app
