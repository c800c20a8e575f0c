// The drift of a device over its checks: one panel a quantity, real dates, the tolerance as a band.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "report/drawing.h"

namespace striae::report {

struct DriftPoint {
  UtcTime at;
  double value = 0;
  double limit = 0;  ///< of the amount of `value`, as it was in force at that check
  bool passed = true;
};

struct DriftPanel {
  std::string title, unit;         ///< "Flatness", "mm"
  std::vector<DriftPoint> points;  ///< by time
};

/// The panels one below the other, `width_pt` wide. Green dots passed, red crosses failed; the band is grey. A panel
/// without points is left out. Deterministic.
Drawing DrawDrift(const std::string& title, const std::vector<DriftPanel>& panels, double width_pt);

/// The drawing as a one-page PDF of its size. kInternal when Cairo fails.
Result<std::vector<std::uint8_t>> PdfDrawing(const Drawing& drawing, const std::string& title, const UtcTime& made_at);

}  // namespace striae::report
