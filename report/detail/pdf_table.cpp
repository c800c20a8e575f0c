#include <algorithm>

#include "report/detail/escape.h"
#include "report/detail/pdf_blocks.h"
#include "report/detail/pdf_markup.h"

namespace striae::report::detail {
namespace {

constexpr double kLabelWidth = 116, kPadRight = 7, kPad = 2;
constexpr double kFirstWidth = 120, kOtherWidth = 210;
constexpr std::size_t kMostColumns = 5;

/// The visits [first, last) of a section as one table.
struct Band {
  const Section& section;
  std::size_t first, last;
  double first_width, column_width;  ///< the very first visit has no change to show and needs less

  [[nodiscard]] double Width(std::size_t column) const { return column == 0 ? first_width : column_width; }
  [[nodiscard]] double X(std::size_t column) const {
    double x = Sheet::kLeft + kLabelWidth;
    for (std::size_t c = first; c < column; ++c) x += Width(c);
    return x;
  }
};

struct Widths {
  double first, other;
};

/// All bands of a table have the same columns. With few visits the first column does not grow beyond its need.
Widths WidthsFor(std::size_t columns) {
  const double room = Sheet::kContent - kLabelWidth;
  const auto count = static_cast<double>(std::min(columns, kMostColumns));
  const double first = columns < 2 ? room : std::min(kFirstWidth, room / count);
  return {first, columns < 2 ? room : std::min(kOtherWidth, (room - first) / (count - 1))};
}

std::string HeadMarkup(const Column& column) {
  std::string markup =
      Span(Escape(column.visit), 8, "600") + "\n" + Span(Escape(column.date + " · " + column.day), 6.8, "", "#5f6e77");
  if (!column.status.empty()) markup += "\n" + Span(Escape(column.status), 6.8, "", "#5f6e77");
  return markup;
}

std::string LabelMarkup(const Row& row) {
  std::string markup = Span(Escape(row.label), 8, "600");
  if (!row.unit.empty()) markup += Span("\u00a0/\u00a0" + Escape(row.unit), 8, "", "#5f6e77");
  return markup;
}

/// One line of the table; breaks the page when it does not fit.
void DrawLine(Sheet& sheet, const Band& band, const std::string& label, const std::vector<std::string>& cells,
              double rule_pt) {
  double height = sheet.Measure(label, 8, kLabelWidth - kPadRight);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    height = std::max(height, sheet.Measure(cells[i], 8, band.Width(band.first + i) - kPadRight));
  }
  sheet.Need(height + 2 * kPad);
  sheet.TextAt(Sheet::kLeft, sheet.y() + kPad, label, 8, kLabelWidth - kPadRight);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    sheet.TextAt(band.X(band.first + i), sheet.y() + kPad, cells[i], 8, band.Width(band.first + i) - kPadRight);
  }
  sheet.Advance(height + 2 * kPad);
  if (rule_pt > 0) sheet.Rule(sheet.y(), kLineColour, rule_pt);
}

void DrawBand(Sheet& sheet, const Band& band) {
  std::vector<std::string> heads, notes;
  bool any_notes = false;
  for (std::size_t c = band.first; c < band.last; ++c) {
    const Column& column = band.section.columns[c];
    heads.push_back(HeadMarkup(column));
    std::string text;
    for (const std::string& note : column.notes) text += (text.empty() ? "" : "\n") + Escape(note);
    any_notes = any_notes || !text.empty();
    notes.push_back(text.empty() ? "" : Span(text, 6.7, "", "#8a5a00"));
  }
  DrawLine(sheet, band, Span("Quantity", 8, "600"), heads, 1.2);
  for (const Row& row : band.section.rows) {
    std::vector<std::string> cells;
    for (std::size_t c = band.first; c < band.last; ++c) cells.push_back(CellMarkup(row.cells[c]));
    DrawLine(sheet, band, LabelMarkup(row), cells, 0.5);
  }
  if (any_notes) DrawLine(sheet, band, Span("Flags and notes", 6.7, "", "#5f6e77"), notes, 0);
}

}  // namespace

void DrawTable(Sheet& sheet, const Section& section) {
  if (section.rows.empty()) return;
  for (std::size_t first = 0; first < section.columns.size(); first += kMostColumns) {
    const std::size_t last = std::min(first + kMostColumns, section.columns.size());
    const Widths widths = WidthsFor(section.columns.size());
    DrawBand(sheet, {section, first, last, widths.first, widths.other});
    sheet.Advance(4);
  }
  for (const std::string& note : section.notes) sheet.Paragraph(Escape(note), 6.8, kGrey, 2);
}

}  // namespace striae::report::detail
