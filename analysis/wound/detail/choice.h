// Which ring of healthy skin is taken, and whether the skin that it gives may be trusted.
#pragma once

#include <string>
#include <vector>

#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/report.h"
#include "analysis/wound/detail/ring.h"

namespace striae::wound {

/// One ring and the skin that it gives.
struct Attempt {
  Ring ring;
  RingWeights weights;
  Skin skin;
  RadialTrend trend;
};

/// The chosen ring, and what the neighbouring gaps would have given.
struct Choice {
  Attempt chosen;
  bool settled = false;
  double first_gap_mm = 0, first_volume_mm3 = 0;
  std::vector<double> other_gap_volumes_mm3;
};

/// Tries the gaps outwards until the ring shows no radial trend. kMeasurementRefused when even the first ring is cut
/// off.
Result<Choice> ChooseRing(const Scene& scene, const Bed& bed, const Options& options);

/// Refuses skin that cannot be continued (too steep, not smooth), and flags what is doubtful.
Status CheckRing(const Choice& choice, const Options& options, Flags& flags);

/// printf of one number into a message.
std::string Format(const char* format, double value);

}  // namespace striae::wound
