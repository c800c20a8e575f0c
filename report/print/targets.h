// Printable targets as vector PDF at exact scale: the calibration board, and labels with a session's code. Each page
// has a 100 mm ruler, because printers scale unasked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/target.h"
#include "core/time.h"

namespace striae::report {

struct PaperSize {
  std::string name;  ///< "A4", "A3"
  double width_mm = 0, height_mm = 0;
};

/// The smaller of A4 and A3, landscape, that holds the board with a margin of 5 mm at the sides, 5 mm above and 20 mm
/// for ruler and text below; kUsage when neither does.
Result<PaperSize> PaperFor(const CharucoBoard& board);

/// One page. kUsage for a board that no paper holds, whose marker does not leave white around it, or whose dictionary
/// is unknown or too small. `made_at` is the file's creation date: the same input gives the same bytes.
Result<std::vector<std::uint8_t>> PdfBoard(const CharucoBoard& board, const UtcTime& made_at);

/// A label with what else a person should read on it ("S001  V1").
struct LabelCard {
  Label label;
  std::vector<std::string> lines;
};

/// Largest marker that an A4 page holds, smallest that is still read from 1 m.
inline constexpr double kLargestLabelMm = 140, kSmallestLabelMm = 20;

/// Labels in rows on A4 portrait, as many pages as they need, with marks for cutting; around each marker at least one
/// module stays white. kUsage when there is none, or for a size or number out of range.
Result<std::vector<std::uint8_t>> PdfLabels(const std::vector<LabelCard>& cards, const UtcTime& made_at);

}  // namespace striae::report
