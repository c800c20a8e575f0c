// Rigs of the toolkit's own for simulation: nominal geometry of the two ranges, with made-up deviations.
#pragma once

#include "core/calibration.h"

namespace striae::rig {

enum class Range { kSmall, kLarge };

/// What a calibration does not say about a rig.
struct RigNominal {
  double distance_mm = 1000;  ///< where the lenses are focused and the field is centred
  Calibration calibration;
};

/// The rig that simulation uses when no file is given: full D90 sensor, D90 lens focused at the range's distance.
RigNominal DefaultRig(Range range);

/// The same rig with a sensor of `scale` times as many pixels a side (0 < scale <= 1), as if pixels were binned.
Calibration ScaleSensor(const Calibration& calibration, double scale);

}  // namespace striae::rig
