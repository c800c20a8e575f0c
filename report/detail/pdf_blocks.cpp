#include "report/detail/pdf_blocks.h"

#include <algorithm>
#include <cmath>

#include "report/detail/escape.h"
#include "report/detail/pdf_markup.h"
#include "report/detail/thumbnail.h"

namespace striae::report::detail {
namespace {

std::string Bold(const std::string& escaped) { return "<span weight=\"600\">" + escaped + "</span>"; }

/// Parts stay whole unless they are longer than a line might be.
std::string PartsMarkup(const std::vector<std::string>& parts) {
  constexpr std::size_t kLongest = 40;
  std::string markup;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string text = Escape(parts[i]) + (i + 1 < parts.size() ? ";" : "");
    markup += i == 0 ? "" : " ";
    markup += text.size() > kLongest ? text : "<span allow_breaks=\"false\">" + text + "</span>";
  }
  return markup;
}

/// A picture inside a box, as large as fits, at its upper left; as JPEG bytes in the file.
void DrawPicture(Sheet& sheet, const std::vector<std::uint8_t>& bytes, const std::string& kind, double x, double top,
                 double width, double height) {
  const auto thumbnail = bytes.empty() ? Result<Thumbnail>(Fail(ErrorCode::kNotFound, "")) : MakeThumbnail(bytes);
  if (!thumbnail) {
    const std::string text = bytes.empty() ? "no " + kind : "the " + kind + " cannot be shown";
    sheet.Box(x, top, width, height, 3, kSoft);
    sheet.TextAt(x + 6, top + height / 2 - 5, text, 6.6, width - 12, kGrey);
    return;
  }
  const double scale = std::min(width / thumbnail->width_px, height / thumbnail->height_px);
  const SurfacePtr image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, thumbnail->width_px, thumbnail->height_px));
  auto* data = new std::vector<std::uint8_t>(thumbnail->jpeg);  // freed by Cairo with the surface
  cairo_surface_set_mime_data(
      image.get(), CAIRO_MIME_TYPE_JPEG, data->data(), data->size(),
      [](void* p) { delete static_cast<std::vector<std::uint8_t>*>(p); }, data);
  cairo_t* context = sheet.context();
  cairo_save(context);
  cairo_translate(context, x, top);
  cairo_scale(context, scale, scale);
  cairo_set_source_surface(context, image.get(), 0, 0);
  cairo_paint(context);
  cairo_restore(context);
}

}  // namespace

void DrawHeader(Sheet& sheet, const Page& page) {
  sheet.Paragraph(Bold("Subject " + Escape(page.title)), 18, kInk, 0);
  sheet.Paragraph(Escape(page.subtitle), 9.5, kGrey, 6);
  sheet.Rule(sheet.y(), kAccent, 1.4);
  sheet.Advance(6);
  constexpr double kGap = 20, kLabel = 54, kSize = 7.5;
  const double half = (Sheet::kContent - kGap) / 2;
  for (std::size_t i = 0; i < page.header.size(); i += 2) {
    double height = 0;
    for (std::size_t j = i; j < std::min(i + 2, page.header.size()); ++j) {
      const double x = Sheet::kLeft + static_cast<double>(j - i) * (half + kGap);
      sheet.TextAt(x, sheet.y(), Escape(page.header[j].label), kSize, kLabel, kGrey);
      height = std::max(height,
                        sheet.TextAt(x + kLabel, sheet.y(), PartsMarkup(page.header[j].parts), kSize, half - kLabel));
    }
    sheet.Advance(height + 2.2);
  }
  sheet.Advance(3);
  sheet.Rule(sheet.y(), kLineColour, 0.7);
  sheet.Advance(4);
  for (const std::string& warning : page.warnings) sheet.Paragraph(Bold(Escape(warning)), 8, kBad, 3);
}

void DrawHeadlines(Sheet& sheet, const std::vector<Headline>& headlines) {
  if (headlines.empty()) return;
  constexpr double kGap = 10, kPad = 8;
  const auto count = static_cast<double>(headlines.size());
  const double width = (Sheet::kContent - kGap * (count - 1)) / count;
  std::vector<std::string> markups;
  double height = 0;
  for (const Headline& h : headlines) {
    std::string markup = Span(Escape(h.label + " · " + h.when), 7, "", "#5f6e77") + "\n" +
                         Span(Escape(h.cell.value), 12.5, "600") + " " + Span(Escape(h.unit), 8, "", "#5f6e77") +
                         FlagMarkup(h.cell, 7);
    const std::string second = SecondMarkup(h.cell, 7);
    if (!second.empty()) markup += "\n" + second;
    height = std::max(height, sheet.Measure(markup, 8, width - 2 * kPad));
    markups.push_back(markup);
  }
  sheet.Need(height + 2 * kPad);
  for (std::size_t i = 0; i < markups.size(); ++i) {
    const double x = Sheet::kLeft + static_cast<double>(i) * (width + kGap);
    sheet.Box(x, sheet.y(), width, height + 1.4 * kPad, 4, kSoft);
    sheet.TextAt(x + kPad, sheet.y() + 0.7 * kPad, markups[i], 8, width - 2 * kPad);
  }
  sheet.Advance(height + 1.4 * kPad + 8);
}

void DrawPlots(Sheet& sheet, const Section& section) {
  if (section.plots.empty()) return;
  double height = 0;
  for (const Drawing& plot : section.plots) height = std::max(height, plot.height);
  const double caption = sheet.Measure(Escape(section.plot_caption), 6.6, Sheet::kContent);
  sheet.Need(height + caption + 6);
  sheet.Advance(5);
  double x = Sheet::kLeft;
  constexpr double kGap = 18;
  for (const Drawing& plot : section.plots) {
    Paint(sheet.context(), plot, x, sheet.y());
    x += plot.width + kGap;
  }
  sheet.Advance(height);
  sheet.Paragraph(Escape(section.plot_caption), 6.6, kGrey, 6);
}

void DrawPictures(Sheet& sheet, const std::vector<PictureCard>& cards, double reserve, bool grow) {
  constexpr std::size_t kMost = 4;
  constexpr double kGap = 10, kInner = 4, kCaption = 11, kAfter = 8, kLeast = 52, kAspect = 0.72;
  for (std::size_t start = 0; start < cards.size(); start += kMost) {
    const std::size_t end = std::min(start + kMost, cards.size());
    const double kept = end == cards.size() ? reserve : 0;
    const auto columns = static_cast<double>(std::clamp<std::size_t>(cards.size(), 2, kMost));
    const double width = (Sheet::kContent - kGap * (columns - 1)) / columns;
    const double half = (width - kInner) / 2;
    sheet.Need(kCaption + kLeast + kAfter + kept);
    const double room = sheet.Room() - kept - kCaption - kAfter;
    const double beside = std::min(room, kAspect * half);
    const double stacked = grow ? std::min((room - kInner) / 2, kAspect * width) : 0;
    const bool one_above_other = stacked > beside;
    const double height = one_above_other ? stacked : beside;
    for (std::size_t i = start; i < end; ++i) {
      const double x = Sheet::kLeft + static_cast<double>(i - start) * (width + kGap);
      const double top = sheet.y() + kCaption;
      sheet.TextAt(x, sheet.y(), Escape(cards[i].caption), 6.8, width, kGrey);
      DrawPicture(sheet, cards[i].photograph, "photograph", x, top, one_above_other ? width : half, height);
      if (one_above_other) {
        DrawPicture(sheet, cards[i].depth_map, "depth map", x, top + height + kInner, width, height);
      } else {
        DrawPicture(sheet, cards[i].depth_map, "depth map", x + half + kInner, top, half, height);
      }
    }
    sheet.Advance(kCaption + (one_above_other ? 2 * height + kInner : height) + kAfter);
  }
}

double DrawEnd(Sheet& sheet, const Page& page, bool draw) {
  double height = 0;
  const auto put = [&](const std::string& markup, double size, Rgb8 colour, double after) {
    height += sheet.Measure(markup, size, Sheet::kContent) + after;
    if (draw) sheet.Paragraph(markup, size, colour, after);
  };
  if (!page.missing.empty()) {
    put(Bold("Missing and failed"), 8.6, kInk, 2);
    for (const std::string& line : page.missing) put("• " + Escape(line), 7.2, kInk, 1.5);
  }
  height += 8;
  if (draw) {
    sheet.Need(30);
    sheet.Rule(sheet.y() + 3, kLineColour, 0.7);
    sheet.Advance(8);
  }
  for (const std::string& line : page.footer) put(Escape(line), 6.3, kGrey, 1);
  return height;
}

}  // namespace striae::report::detail
