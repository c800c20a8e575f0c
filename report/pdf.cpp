#include <cairo/cairo-pdf.h>

#include "report/detail/escape.h"
#include "report/detail/pdf_blocks.h"
#include "report/page.h"
#include "report/report.h"

namespace striae::report {
namespace {

using detail::Sheet;

cairo_status_t Append(void* closure, const unsigned char* data, unsigned int length) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(closure);
  bytes.insert(bytes.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

/// Fills the pages and says how many there are.
int Draw(cairo_t* context, const Page& page, int pages) {
  Sheet sheet(context, detail::Escape("Subject " + page.title + " · generated " + page.generated), pages);
  detail::DrawHeader(sheet, page);
  const double end = detail::DrawEnd(sheet, page, false);
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    const Section& section = page.sections[i];
    sheet.Need(90);
    sheet.Advance(5);
    sheet.Paragraph("<span weight=\"600\">" + detail::Escape(section.title) + "</span>", 11.5, detail::kInk, 5);
    detail::DrawHeadlines(sheet, section.headlines);
    detail::DrawTable(sheet, section);
    detail::DrawPlots(sheet, section);
    const bool last = i + 1 == page.sections.size();
    // Pictures of an earlier section stay small: the next one needs the page too.
    detail::DrawPictures(sheet, section.pictures, last ? end : 0, last);
  }
  if (page.sections.empty()) {
    sheet.Paragraph("Nothing has been captured for this subject yet.", 9, detail::kGrey, 6);
  }
  detail::DrawEnd(sheet, page, true);
  sheet.Finish();
  return sheet.page();
}

/// The whole file; `pages` is what the page numbers say. The number of pages it has comes back in `drawn`.
Result<std::vector<std::uint8_t>> Write(const Page& page, const std::string& created, int pages, int& drawn) {
  std::vector<std::uint8_t> bytes;
  const detail::SurfacePtr surface(cairo_pdf_surface_create_for_stream(Append, &bytes, Sheet::kWidth, Sheet::kHeight));
  cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_5);
  const std::string title = detail::CleanText("Subject " + page.title + ", " + page.subtitle);
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "striae");
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, created.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_MOD_DATE, created.c_str());
  cairo_status_t status = CAIRO_STATUS_SUCCESS;
  {
    const detail::ContextPtr context(cairo_create(surface.get()));
    drawn = Draw(context.get(), page, pages);
    status = cairo_status(context.get());
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    return Fail(ErrorCode::kInternal, std::string("the PDF could not be made: ") + cairo_status_to_string(status));
  }
  return bytes;
}

}  // namespace

Result<std::vector<std::uint8_t>> PdfReport(const SubjectReport& subject) {
  const Page page = BuildPage(subject);
  // Cairo takes seconds, not milliseconds.
  const std::string created = subject.generated_at.ToString().substr(0, 19) + "Z";
  int pages = 0;
  auto counted = Write(page, created, 1, pages);
  if (!counted || pages == 1) return counted;
  int drawn = 0;
  return Write(page, created, pages, drawn);
}

}  // namespace striae::report
