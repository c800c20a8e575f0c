#include "report/detail/cairo_paint.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "report/detail/codec.h"
#include "report/detail/escape.h"

namespace striae::report::detail {
namespace {

// Inter has even-width figures for tables; the others are what Debian has when it is not installed.
constexpr const char* kTypeface = "Inter, Lato, DejaVu Sans, sans-serif";

void PathOf(cairo_t* context, const Shape& shape) {
  cairo_new_path(context);
  if (shape.kind == Shape::Kind::kCircle) {
    cairo_arc(context, shape.points[0].x, shape.points[0].y, shape.size, 0, 2 * G_PI);
    return;
  }
  for (const Point& p : shape.points) cairo_line_to(context, p.x, p.y);
  if (shape.kind == Shape::Kind::kPolygon) cairo_close_path(context);
}

void PaintText(cairo_t* context, const Shape& shape) {
  const std::string escaped = Escape(shape.text);
  const LayoutPtr layout =
      MakeText(context, shape.bold ? "<span weight=\"600\">" + escaped + "</span>" : escaped, shape.size);
  const TextSize size = SizeOf(layout.get());
  const double shift = shape.anchor == Anchor::kStart ? 0 : shape.anchor == Anchor::kEnd ? size.width : size.width / 2;
  SetColour(context, shape.colour);
  cairo_move_to(context, shape.points[0].x - shift, shape.points[0].y - size.baseline);
  pango_cairo_show_layout(context, layout.get());
}

void PaintShape(cairo_t* context, const Shape& shape) {
  if (shape.kind == Shape::Kind::kText) {
    PaintText(context, shape);
    return;
  }
  PathOf(context, shape);
  const bool line = shape.kind == Shape::Kind::kLine;
  if (!line && shape.filled) {
    SetColour(context, shape.fill);
    cairo_fill_preserve(context);
  }
  const double width = line ? shape.size : shape.stroke;
  if (width > 0) {
    static constexpr double kDashes[] = {3, 3};
    cairo_set_dash(context, kDashes, shape.dashed ? 2 : 0, 0);
    cairo_set_line_width(context, width);
    SetColour(context, shape.colour);
    cairo_stroke(context);
  }
  cairo_new_path(context);
}

}  // namespace

void SetColour(cairo_t* context, Rgb8 colour) {
  cairo_set_source_rgb(context, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

LayoutPtr MakeText(cairo_t* context, const std::string& markup, double size_pt, double width_pt) {
  LayoutPtr layout(pango_cairo_create_layout(context));
  // One unit of the page is a point, without rounding to a screen's pixels.
  pango_cairo_context_set_resolution(pango_layout_get_context(layout.get()), 72);
  const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(cairo_font_options_create(),
                                                                                       cairo_font_options_destroy);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(pango_layout_get_context(layout.get()), options.get());
  pango_context_set_round_glyph_positions(pango_layout_get_context(layout.get()), FALSE);
  const std::unique_ptr<PangoFontDescription, CairoFree> font(pango_font_description_from_string(kTypeface));
  pango_font_description_set_absolute_size(font.get(), size_pt * PANGO_SCALE);
  pango_layout_set_font_description(layout.get(), font.get());
  if (width_pt > 0) {
    pango_layout_set_width(layout.get(), static_cast<int>(width_pt * PANGO_SCALE));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  }
  pango_layout_set_markup(layout.get(), ("<span font_features=\"tnum=1\">" + markup + "</span>").c_str(), -1);
  return layout;
}

TextSize SizeOf(PangoLayout* layout) {
  int width = 0, height = 0;
  pango_layout_get_size(layout, &width, &height);
  constexpr double kScale = PANGO_SCALE;
  return {width / kScale, height / kScale, pango_layout_get_baseline(layout) / kScale};
}

void Paint(cairo_t* context, const Drawing& drawing, double x, double y) {
  cairo_save(context);
  cairo_translate(context, x, y);
  for (const Shape& shape : drawing.shapes) PaintShape(context, shape);
  cairo_restore(context);
}

SurfacePtr ToCairo(const ImageRgb& image) {
  SurfacePtr surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width(), image.height()));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return surface;
  cairo_surface_flush(surface.get());
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < image.height(); ++y) {
    const Rgb8* row = image.Row(y);
    for (int x = 0; x < image.width(); ++x) {
      const std::uint32_t pixel =
          (static_cast<std::uint32_t>(row[x].r) << 16U) | (static_cast<std::uint32_t>(row[x].g) << 8U) | row[x].b;
      std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4, &pixel, 4);
    }
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

}  // namespace striae::report::detail

namespace striae::report {

ImageRgb Rasterise(const Drawing& drawing, double scale) {
  const int width = std::max(1, static_cast<int>(std::lround(drawing.width * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(drawing.height * scale)));
  const detail::SurfacePtr surface = detail::ToCairo(ImageRgb(width, height, {255, 255, 255}));
  const detail::ContextPtr context(cairo_create(surface.get()));
  cairo_scale(context.get(), scale, scale);
  detail::Paint(context.get(), drawing, 0, 0);
  return detail::FromCairo(surface.get());
}

}  // namespace striae::report
