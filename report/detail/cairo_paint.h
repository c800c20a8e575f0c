// Cairo and Pango behind few functions: owners, colours, text, drawings, PNG.
#pragma once

#include <memory>
#include <string>

#include <cairo/cairo.h>
#include <pango/pangocairo.h>

#include "report/drawing.h"

namespace striae::report::detail {

struct CairoFree {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
  void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
};
using ContextPtr = std::unique_ptr<cairo_t, CairoFree>;
using SurfacePtr = std::unique_ptr<cairo_surface_t, CairoFree>;
using LayoutPtr = std::unique_ptr<PangoLayout, CairoFree>;

void SetColour(cairo_t* context, Rgb8 colour);

/// A layout of Pango markup (already escaped) in the report's typeface; wraps at `width_pt` when that is positive.
LayoutPtr MakeText(cairo_t* context, const std::string& markup, double size_pt, double width_pt = 0);

struct TextSize {
  double width = 0, height = 0, baseline = 0;
};
TextSize SizeOf(PangoLayout* layout);

/// Paints a drawing with its upper left corner at (x, y), one unit a point.
void Paint(cairo_t* context, const Drawing& drawing, double x, double y);

/// RGB pixels as a Cairo image of their own.
SurfacePtr ToCairo(const ImageRgb& image);
/// The pixels of an RGB24 image.
ImageRgb FromCairo(cairo_surface_t* surface);

}  // namespace striae::report::detail
