// A PDF of pages in millimetres, and what every printed page has.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "report/detail/cairo_paint.h"

namespace striae::report::detail {

inline constexpr double kPointsPerMm = 72 / 25.4;

struct PdfFile {
  std::string title;
  double width_mm = 0, height_mm = 0;
  UtcTime made_at;
};

/// Calls `paint` once a page, 0 to `pages` - 1, with millimetres as the context's unit and its origin at the upper left
/// corner. kInternal when Cairo fails.
Result<std::vector<std::uint8_t>> WritePdf(const PdfFile& file, int pages,
                                           const std::function<void(cairo_t*, int page)>& paint);

/// Adds the black modules of `modules`, `side_mm` wide with the upper left corner at (x, y), to the current path. All
/// that is black on a page is filled as one path: pieces filled one by one show hairlines where they touch.
void AddModules(cairo_t* context, const Mask& modules, double x_mm, double y_mm, double side_mm);

/// One line of plain text, its upper left corner at (x, y); its width in mm.
double TextMm(cairo_t* context, double x_mm, double y_mm, const std::string& text, double size_pt, bool bold = false);

/// A ruler of exactly 100 mm with its upper left corner at (x, y), 9 mm high, and how to print.
void Ruler(cairo_t* context, double x_mm, double y_mm);

}  // namespace striae::report::detail
