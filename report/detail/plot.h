// Values over the real days of the visits, with 95 % error bars, as a Drawing.
#pragma once

#include <string>
#include <vector>

#include "report/drawing.h"

namespace striae::report::detail {

struct PlotPoint {
  double day = 0, value = 0;
  double uncertainty = 0;  ///< standard uncertainty; the bar is 1.96 times as long to either side
  bool flagged = false;    ///< drawn hollow
  std::string visit;       ///< "V1"
  double place = 0;        ///< on the axis; set by DrawPlot
};

struct PlotLine {
  std::string label;
  std::vector<PlotPoint> points;  ///< by day
};

/// One panel `width_pt` wide: the lines, a band of 1.96 sqrt(2) u about each line's first value (a change inside it is
/// within error if later values are as certain), ticks on the days of the visits, zero always included.
Drawing DrawPlot(const std::string& title, const std::string& unit, const std::vector<PlotLine>& lines,
                 std::size_t first_colour, double width_pt, double height_pt);

}  // namespace striae::report::detail
