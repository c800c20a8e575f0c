// From the figures of one wound to the coded measurements of the report.
#pragma once

#include <string>
#include <vector>

#include "analysis/wound/wound.h"

namespace striae::wound {

/// A value with its standard uncertainty, in mm, mm2 or mm3.
struct Figure {
  double value = 0, uncertainty = 0;
};

struct Figures {
  Figure volume, proud_volume;                                        ///< mm3
  Figure area, bed_area;                                              ///< mm2
  Figure perimeter, depth_max, depth_p95, depth_mean, length, width;  ///< mm
};

/// Why numbers are flagged: all of them, those that need the surface inside, or the volume alone.
struct Flags {
  std::vector<std::string> all, inside, volume;
};

/// Measurements in CONTRACT's order, names, units and codes.
std::vector<Measurement> CodedMeasurements(const Figures& figures, const Flags& flags);

/// The parameters as provenance keeps them.
nlohmann::json ToJson(const Options& options);

}  // namespace striae::wound
