// The labels' pages.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/print/detail/marker.h"
#include "report/print/detail/pdf_file.h"
#include "report/print/targets.h"

namespace striae::report {
namespace {

constexpr double kPageWidth = 210, kPageHeight = 297, kMargin = 10, kFoot = 20;
constexpr double kGap = 4;          // between cards, for scissors
constexpr double kLineHeight = 4;   // mm, of a line of small text
constexpr double kSmallText = 8;    // pt
constexpr double kCodeShare = 6.2;  // a code of nine characters, that many times as wide as high, fills the marker

struct Size {
  double width = 0, height = 0;
};

/// White around the marker: a module (a sixth of its side), at least 5 mm for a finger.
double Quiet(const Label& label) { return std::max(label.side_mm / 6, 5.0); }

double CodeHeight(const Label& label) { return label.side_mm / kCodeShare; }

Size SizeOfCard(const LabelCard& card) {
  const double quiet = Quiet(card.label);
  const double text = 1.4 * CodeHeight(card.label) + kLineHeight * static_cast<double>(card.lines.size() + 1);
  return {card.label.side_mm + 2 * quiet, card.label.side_mm + 2 * quiet + text + 2};
}

struct Place {
  int page = 0;
  double x = 0, y = 0;
};

/// Left to right, then down, then the next page.
std::vector<Place> Arrange(const std::vector<LabelCard>& cards) {
  std::vector<Place> places;
  Place at{0, kMargin, kMargin};
  double row_height = 0;
  for (const LabelCard& card : cards) {
    const Size size = SizeOfCard(card);
    if (at.x + size.width > kPageWidth - kMargin) {
      at.x = kMargin;
      at.y += row_height + kGap;
      row_height = 0;
    }
    if (at.y + size.height > kPageHeight - kFoot) at = {at.page + 1, kMargin, kMargin};
    places.push_back(at);
    at.x += size.width + kGap;
    row_height = std::max(row_height, size.height);
  }
  return places;
}

void CuttingLine(cairo_t* context, const Place& at, const Size& size) {
  static constexpr double kDashes[] = {1, 1};
  cairo_save(context);
  cairo_set_dash(context, kDashes, 2, 0);
  cairo_set_line_width(context, 0.1);
  detail::SetColour(context, {150, 150, 150});
  cairo_rectangle(context, at.x, at.y, size.width, size.height);
  cairo_stroke(context);
  cairo_restore(context);
}

void DrawCard(cairo_t* context, const LabelCard& card, const Mask& modules, const Place& at) {
  const Label& label = card.label;
  const double quiet = Quiet(label), left = at.x + quiet;
  CuttingLine(context, at, SizeOfCard(card));
  cairo_new_path(context);
  detail::AddModules(context, modules, left, at.y + quiet, label.side_mm);
  detail::SetColour(context, {0, 0, 0});
  cairo_fill(context);
  // Under the white that the marker needs on this side too.
  double y = at.y + label.side_mm + 2 * quiet;
  detail::TextMm(context, left, y, label.session_code, CodeHeight(label) * detail::kPointsPerMm, true);
  y += 1.4 * CodeHeight(label);
  for (const std::string& line : card.lines) {
    detail::TextMm(context, left, y, line, kSmallText);
    y += kLineHeight;
  }
  detail::TextMm(context, left, y, fmt::format("marker {}, {:g} mm", label.marker_id, label.side_mm), kSmallText);
}

}  // namespace

Result<std::vector<std::uint8_t>> PdfLabels(const std::vector<LabelCard>& cards, const UtcTime& made_at) {
  if (cards.empty()) return Fail(ErrorCode::kUsage, "there is no label to print; name a session");
  std::vector<Mask> markers;
  for (const LabelCard& card : cards) {
    const double side = card.label.side_mm;
    if (!(side >= kSmallestLabelMm && side <= kLargestLabelMm)) {
      return Fail(ErrorCode::kUsage,
                  fmt::format("a label of {:g} mm cannot be printed on A4 and read; use {:g} to {:g}", side,
                              kSmallestLabelMm, kLargestLabelMm));
    }
    auto modules = detail::MarkerModules(std::string(kLabelDictionary), card.label.marker_id);
    if (!modules) return Fail(modules.error());
    markers.push_back(*std::move(modules));
  }
  const std::vector<Place> places = Arrange(cards);
  const detail::PdfFile file{"Striae labels", kPageWidth, kPageHeight, made_at};
  return detail::WritePdf(file, places.back().page + 1, [&](cairo_t* context, int page) {
    for (std::size_t i = 0; i < cards.size(); ++i) {
      if (places[i].page == page) DrawCard(context, cards[i], markers[i], places[i]);
    }
    detail::Ruler(context, kMargin, kPageHeight - kFoot + 4);
    detail::TextMm(context, kMargin, kPageHeight - kFoot + 12,
                   "Striae labels: marker dictionary " + std::string(kLabelDictionary) +
                       ". Cut along the dashes; keep the white around the marker.",
                   kSmallText);
  });
}

}  // namespace striae::report
