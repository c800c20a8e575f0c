#include "report/detail/sheet.h"

#include <utility>

namespace striae::report::detail {
namespace {

constexpr double kFootSize = 6.4;

}  // namespace

Sheet::Sheet(cairo_t* context, std::string page_note, int pages)
    : context_(context), page_note_(std::move(page_note)), pages_(pages) {}

void Sheet::Need(double height) {
  if (height <= Room() || y_ <= kTop) return;
  Finish();
  ++page_;
  y_ = kTop;
}

void Sheet::Finish() {
  Foot();
  cairo_show_page(context_);
}

void Sheet::Foot() const {
  const std::string count = "page " + std::to_string(page_) + " of " + std::to_string(pages_);
  TextAt(kLeft, kHeight - 26, page_note_, kFootSize, kContent - 70, kGrey);
  const LayoutPtr layout = MakeText(context_, count, kFootSize);
  SetColour(context_, kGrey);
  cairo_move_to(context_, kRight - SizeOf(layout.get()).width, kHeight - 26);
  pango_cairo_show_layout(context_, layout.get());
}

double Sheet::Measure(const std::string& markup, double size, double width) const {
  return SizeOf(MakeText(context_, markup, size, width).get()).height;
}

double Sheet::TextAt(double x, double top, const std::string& markup, double size, double width, Rgb8 colour) const {
  const LayoutPtr layout = MakeText(context_, markup, size, width);
  SetColour(context_, colour);
  cairo_move_to(context_, x, top);
  pango_cairo_show_layout(context_, layout.get());
  return SizeOf(layout.get()).height;
}

void Sheet::Paragraph(const std::string& markup, double size, Rgb8 colour, double space_after) {
  Need(Measure(markup, size, kContent));
  y_ += TextAt(kLeft, y_, markup, size, kContent, colour) + space_after;
}

void Sheet::Rule(double top, Rgb8 colour, double width_pt) const {
  SetColour(context_, colour);
  cairo_set_line_width(context_, width_pt);
  cairo_set_dash(context_, nullptr, 0, 0);
  cairo_move_to(context_, kLeft, top);
  cairo_line_to(context_, kRight, top);
  cairo_stroke(context_);
}

void Sheet::Box(double x, double top, double width, double height, double radius, Rgb8 fill) const {
  cairo_new_path(context_);
  cairo_arc(context_, x + width - radius, top + radius, radius, -G_PI / 2, 0);
  cairo_arc(context_, x + width - radius, top + height - radius, radius, 0, G_PI / 2);
  cairo_arc(context_, x + radius, top + height - radius, radius, G_PI / 2, G_PI);
  cairo_arc(context_, x + radius, top + radius, radius, G_PI, 3 * G_PI / 2);
  cairo_close_path(context_);
  SetColour(context_, fill);
  cairo_fill(context_);
}

}  // namespace striae::report::detail
