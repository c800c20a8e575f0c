// The parts of the printed report, each drawn at the sheet's cursor.
#pragma once

#include "report/detail/sheet.h"
#include "report/page.h"

namespace striae::report::detail {

void DrawHeader(Sheet& sheet, const Page& page);
void DrawHeadlines(Sheet& sheet, const std::vector<Headline>& headlines);
/// In bands of at most five visits.
void DrawTable(Sheet& sheet, const Section& section);
void DrawPlots(Sheet& sheet, const Section& section);
/// One strip, a visit a column: photograph and depth map one above the other where the page has room for it beside
/// `reserve` points and `grow` is set, side by side otherwise.
void DrawPictures(Sheet& sheet, const std::vector<PictureCard>& cards, double reserve, bool grow);
/// Missing captures and the footer; with `draw` false only their height.
double DrawEnd(Sheet& sheet, const Page& page, bool draw);

}  // namespace striae::report::detail
