// The calibration board's page.
#include <fmt/format.h>

#include "report/print/detail/marker.h"
#include "report/print/detail/pdf_file.h"
#include "report/print/targets.h"

namespace striae::report {
namespace {

constexpr double kSide = 5, kAbove = 5, kBelow = 20;

/// The markers in the order of their numbers, which is that of the white squares from the top left.
Result<std::vector<Mask>> Markers(const CharucoBoard& board) {
  std::vector<Mask> markers;
  for (int id = 0; id < board.columns * board.rows / 2; ++id) {
    auto modules = detail::MarkerModules(board.dictionary, id);
    if (!modules) return Fail(modules.error());
    markers.push_back(*std::move(modules));
  }
  return markers;
}

void DrawBoard(cairo_t* context, const CharucoBoard& board, const std::vector<Mask>& markers, double left, double top) {
  const double inset = (board.square_mm - board.marker_mm) / 2;
  std::size_t next = 0;
  cairo_new_path(context);
  for (int row = 0; row < board.rows; ++row) {
    for (int col = 0; col < board.columns; ++col) {
      const double x = left + col * board.square_mm, y = top + row * board.square_mm;
      if ((row + col) % 2 == 0) {
        cairo_rectangle(context, x, y, board.square_mm, board.square_mm);
      } else {
        detail::AddModules(context, markers[next++], x + inset, y + inset, board.marker_mm);
      }
    }
  }
  detail::SetColour(context, {0, 0, 0});
  cairo_fill(context);
}

}  // namespace

Result<PaperSize> PaperFor(const CharucoBoard& board) {
  const double width = board.columns * board.square_mm + 2 * kSide;
  const double height = board.rows * board.square_mm + kAbove + kBelow;
  for (const PaperSize& paper : {PaperSize{"A4", 297, 210}, PaperSize{"A3", 420, 297}}) {
    if (width <= paper.width_mm && height <= paper.height_mm) return paper;
  }
  return Fail(ErrorCode::kUsage, fmt::format("a board of {:.0f} x {:.0f} mm does not fit on A3; use smaller squares",
                                             board.columns * board.square_mm, board.rows * board.square_mm));
}

Result<std::vector<std::uint8_t>> PdfBoard(const CharucoBoard& board, const UtcTime& made_at) {
  if (board.columns < 3 || board.rows < 3 || board.rows % 2 == 0 || !(board.marker_mm > 0) ||
      !(board.marker_mm < board.square_mm)) {
    return Fail(ErrorCode::kUsage,
                "a board needs 3 or more columns, an odd number of rows, and markers smaller than their squares");
  }
  const auto paper = PaperFor(board);
  if (!paper) return Fail(paper.error());
  const auto markers = Markers(board);
  if (!markers) return Fail(markers.error());
  const std::string what = fmt::format("Striae calibration board: {} x {} squares of {:g} mm, markers {:g} mm, {}",
                                       board.columns, board.rows, board.square_mm, board.marker_mm, board.dictionary);
  const double left = (paper->width_mm - board.columns * board.square_mm) / 2;
  const double height = board.rows * board.square_mm;
  const double top = (paper->height_mm - height - kBelow + kAbove) / 2;
  return detail::WritePdf({what, paper->width_mm, paper->height_mm, made_at}, 1, [&](cairo_t* context, int /*page*/) {
    DrawBoard(context, board, *markers, left, top);
    const double foot = top + height + 4;
    detail::Ruler(context, left, foot);
    detail::TextMm(context, left, foot + 8, what + ". Paper " + paper->name + ". Glue it to a flat plate.", 7.5);
  });
}

}  // namespace striae::report
