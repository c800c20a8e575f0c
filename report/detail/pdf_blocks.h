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
/// One strip: photographs above, depth maps below, a visit a column. With `grow` the pictures become as large as the
/// page has room for beside `reserve` points; otherwise they stay small.
void DrawPictures(Sheet& sheet, const std::vector<PictureCard>& cards, double reserve, bool grow);
/// Missing captures and the footer; with `draw` false only their height.
double DrawEnd(Sheet& sheet, const Page& page, bool draw);

}  // namespace striae::report::detail
