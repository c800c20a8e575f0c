// Pango markup of table cells and large numbers.
#pragma once

#include <string>

#include "report/page.h"

namespace striae::report::detail {

/// <span> with a size in points and, when not empty, a weight and a colour ("#rrggbb").
std::string Span(const std::string& escaped, double size_pt, const std::string& weight = "",
                 const std::string& colour = "");
std::string FlagMarkup(const Cell& cell, double size_pt);
/// Words, verdict, change and limit, each unbroken; empty when there is nothing.
std::string SecondMarkup(const Cell& cell, double size_pt);
std::string CellMarkup(const Cell& cell);

}  // namespace striae::report::detail
