// The whole numbers of a calibration: real offsets settle on them, and the grating's edges say where counting begins.
#pragma once

#include <optional>
#include <vector>

#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::detail {

struct Settled {
  std::vector<double> whole;     ///< each offset's whole number
  std::vector<double> distance;  ///< what rounding took from each, stripes
  double fraction = 0;           ///< common to all; belongs to the central order
};
/// Rounds offsets to whole numbers about their common fraction.
Settled SettleOffsets(const std::vector<double>& offsets);

/// The whole number that brings the orders at the visible edges of the stripe field to -0.5 and N - 0.5; nullopt when
/// no photograph shows an edge or they disagree. `low` and `high` are one entry a photograph.
struct SeenEdges {
  std::optional<double> low, high;
};
std::optional<int> GaugeFromEdges(const std::vector<SeenEdges>& edges, const std::vector<double>& offsets,
                                  std::optional<int> stripes);

}  // namespace striae::reconstruct::detail
