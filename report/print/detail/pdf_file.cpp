#include "report/print/detail/pdf_file.h"

#include <cairo/cairo-pdf.h>

#include "report/detail/escape.h"

namespace striae::report::detail {
namespace {

cairo_status_t Append(void* closure, const unsigned char* data, unsigned int length) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(closure);
  bytes.insert(bytes.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Result<std::vector<std::uint8_t>> WritePdf(const PdfFile& file, int pages,
                                           const std::function<void(cairo_t*, int page)>& paint) {
  std::vector<std::uint8_t> bytes;
  const SurfacePtr surface(
      cairo_pdf_surface_create_for_stream(Append, &bytes, file.width_mm * kPointsPerMm, file.height_mm * kPointsPerMm));
  cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_5);
  // Cairo takes seconds, not milliseconds.
  const std::string made = file.made_at.ToString().substr(0, 19) + "Z";
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, CleanText(file.title).c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "striae");
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, made.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_MOD_DATE, made.c_str());
  cairo_status_t status = CAIRO_STATUS_SUCCESS;
  {
    const ContextPtr context(cairo_create(surface.get()));
    cairo_scale(context.get(), kPointsPerMm, kPointsPerMm);
    for (int page = 0; page < pages; ++page) {
      paint(context.get(), page);
      cairo_show_page(context.get());
    }
    status = cairo_status(context.get());
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    return Fail(ErrorCode::kInternal, std::string("the PDF could not be made: ") + cairo_status_to_string(status));
  }
  return bytes;
}

void AddModules(cairo_t* context, const Mask& modules, double x_mm, double y_mm, double side_mm) {
  const double step = side_mm / modules.width();
  for (int row = 0; row < modules.height(); ++row) {
    for (int col = 0; col < modules.width(); ++col) {
      int end = col;
      while (end < modules.width() && modules(end, row) != 0) ++end;
      if (end > col) cairo_rectangle(context, x_mm + col * step, y_mm + row * step, (end - col) * step, step);
      col = end;
    }
  }
}

double TextMm(cairo_t* context, double x_mm, double y_mm, const std::string& text, double size_pt, bool bold) {
  cairo_save(context);
  cairo_translate(context, x_mm, y_mm);
  cairo_scale(context, 1 / kPointsPerMm, 1 / kPointsPerMm);
  const std::string escaped = Escape(text);
  const LayoutPtr layout = MakeText(context, bold ? "<span weight=\"600\">" + escaped + "</span>" : escaped, size_pt);
  SetColour(context, {0, 0, 0});
  cairo_move_to(context, 0, 0);
  pango_cairo_show_layout(context, layout.get());
  const double width = SizeOf(layout.get()).width;
  cairo_restore(context);
  cairo_new_path(context);
  return width / kPointsPerMm;
}

void Ruler(cairo_t* context, double x_mm, double y_mm) {
  constexpr double kThin = 0.2;
  SetColour(context, {0, 0, 0});
  // Its ends are the outer edges of the first and the last mark.
  cairo_rectangle(context, x_mm, y_mm, 100, kThin);
  for (int mm = 0; mm <= 100; mm += 5) {
    const double left = mm == 0 ? 0 : mm == 100 ? 100 - kThin : mm - kThin / 2;
    cairo_rectangle(context, x_mm + left, y_mm, kThin, mm % 50 == 0 ? 5 : mm % 10 == 0 ? 3.5 : 2);
  }
  cairo_fill(context);
  for (const int mm : {0, 50, 100})
    TextMm(context, x_mm + mm + (mm == 100 ? -6 : 0.8), y_mm + 4.8, std::to_string(mm), 7);
  TextMm(context, x_mm + 104, y_mm, "This ruler is 100 mm long: measure it.", 7.5, true);
  TextMm(context, x_mm + 104, y_mm + 3.6, "Print at 100 % (\"actual size\"), never \"fit to page\".", 7.5);
}

}  // namespace striae::report::detail
