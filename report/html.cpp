#include <string>
#include <string_view>

#include "report/detail/base64.h"
#include "report/detail/escape.h"
#include "report/detail/html_style.h"
#include "report/detail/thumbnail.h"
#include "report/page.h"
#include "report/report.h"

namespace striae::report {
namespace {

using detail::Escape;

std::string Tag(std::string_view name, std::string_view css_class, const std::string& inner) {
  std::string open = "<" + std::string(name);
  if (!css_class.empty()) open += " class=\"" + std::string(css_class) + "\"";
  return open + ">" + inner + "</" + std::string(name) + ">";
}

std::string VerdictClass(Verdict verdict) {
  if (verdict == Verdict::kImproved) return "verdict improved";
  return verdict == Verdict::kWorse ? "verdict worse" : "verdict none";
}

/// What stands below a value: words, change, limit, verdict. The same in the table and under a large number.
std::string SecondLines(const Cell& cell) {
  std::string html;
  if (!cell.words.empty()) html += Tag("div", "words", Escape(cell.words));
  if (!cell.has_verdict) return html;
  std::string line = Tag("span", VerdictClass(cell.verdict), std::string(ToString(cell.verdict)));
  if (!cell.change.empty()) line += " " + Tag("span", "", Escape(cell.change));
  if (!cell.limit.empty()) line += " " + Tag("span", "", Escape(cell.limit));
  if (!cell.verdict_reason.empty()) line += " " + Tag("span", "why", Escape(cell.verdict_reason));
  return html + Tag("div", "second", line);
}

std::string FlagMark(const Cell& cell) {
  return cell.flag.empty() ? "" : " " + Tag("span", "flag", "flag " + Escape(cell.flag));
}

std::string PartsHtml(const std::vector<std::string>& parts) {
  std::string html;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    html += (i == 0 ? "" : " ") + Tag("span", "part", Escape(parts[i]) + (i + 1 < parts.size() ? ";" : ""));
  }
  return html;
}

std::string HeaderHtml(const Page& page) {
  std::string html = "<header>\n" + Tag("h1", "", "Subject " + Escape(page.title)) + "\n" +
                     Tag("p", "subtitle", Escape(page.subtitle)) + "\n<dl>\n";
  for (const Field& field : page.header) {
    html += Tag("div", "", Tag("dt", "", Escape(field.label)) + Tag("dd", "", PartsHtml(field.parts))) + "\n";
  }
  html += "</dl>\n";
  for (const std::string& warning : page.warnings) html += Tag("p", "warning", Escape(warning)) + "\n";
  return html + "</header>\n";
}

std::string HeadlinesHtml(const Section& section) {
  if (section.headlines.empty()) return {};
  std::string html = "<div class=\"headlines\">\n";
  for (const Headline& h : section.headlines) {
    html +=
        Tag("div", "headline",
            Tag("div", "name", Escape(h.label) + " · " + Escape(h.when)) +
                Tag("div", "big", Escape(h.cell.value) + " " + Tag("small", "", Escape(h.unit)) + FlagMark(h.cell)) +
                SecondLines(h.cell)) +
        "\n";
  }
  return html + "</div>\n";
}

/// The first visit has no change to show and needs less width than the others.
std::string ColumnWidths(std::size_t visits) {
  std::string html = "<colgroup><col class=\"quantity\">";
  for (std::size_t i = 0; i < visits; ++i) html += i == 0 && visits < 4 ? "<col class=\"first\">" : "<col>";
  return html + "</colgroup>\n";
}

// Explicit roles: on a narrow screen the table is laid out as blocks, which would take its meaning away.
std::string TableHtml(const Section& section) {
  std::string html = "<table role=\"table\">\n" + ColumnWidths(section.columns.size()) +
                     "<thead role=\"rowgroup\"><tr role=\"row\"><th role=\"columnheader\" "
                     "scope=\"col\">Quantity</th>";
  bool any_notes = false;
  for (const Column& column : section.columns) {
    const std::string below = column.date + " · " + column.day + (column.status.empty() ? "" : " · " + column.status);
    html +=
        "<th role=\"columnheader\" scope=\"col\">" + Escape(column.visit) + Tag("span", "", Escape(below)) + "</th>";
    any_notes = any_notes || !column.notes.empty();
  }
  html += "</tr></thead>\n<tbody role=\"rowgroup\">\n";
  const auto open_cell = [&](std::size_t i) {
    return "<td role=\"cell\" data-visit=\"" + Escape(section.columns[i].visit + " · " + section.columns[i].date) +
           "\">";
  };
  for (const Row& row : section.rows) {
    html += "<tr role=\"row\"><th role=\"rowheader\" scope=\"row\">" + Escape(row.label) +
            (row.unit.empty() ? "" : Tag("span", "", "\u00a0/\u00a0" + Escape(row.unit))) + "</th>";
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const Cell& cell = row.cells[i];
      html += open_cell(i) + Tag("div", "value", Escape(cell.value) + FlagMark(cell)) + SecondLines(cell) + "</td>";
    }
    html += "</tr>\n";
  }
  if (any_notes) {
    html += "<tr role=\"row\" class=\"notes\"><th role=\"rowheader\" scope=\"row\">Flags and notes</th>";
    for (std::size_t i = 0; i < section.columns.size(); ++i) {
      std::string notes;
      for (const std::string& note : section.columns[i].notes) notes += Tag("div", "", Escape(note));
      html += notes.empty() ? std::string("<td role=\"cell\" class=\"empty\"></td>") : open_cell(i) + notes + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table>\n";
}

std::string PictureHtml(const std::vector<std::uint8_t>& picture, const std::string& alt, const std::string& kind) {
  if (picture.empty()) return Tag("div", "lost", "no " + kind);
  const auto thumbnail = detail::MakeThumbnail(picture);
  if (!thumbnail) return Tag("div", "lost", Escape("the " + kind + " cannot be shown: " + thumbnail.error().message));
  return "<img alt=\"" + Escape(alt) + "\" width=\"" + std::to_string(thumbnail->width_px) + "\" height=\"" +
         std::to_string(thumbnail->height_px) + "\" src=\"data:image/jpeg;base64," + detail::Base64(thumbnail->jpeg) +
         "\">";
}

std::string SectionHtml(const Section& section) {
  std::string html = "<section>\n" + Tag("h2", "", Escape(section.title)) + "\n" + HeadlinesHtml(section);
  if (!section.rows.empty()) html += TableHtml(section);
  for (const std::string& note : section.notes) html += Tag("p", "note", Escape(note)) + "\n";
  if (!section.plots.empty()) {
    std::string plots;
    for (const Drawing& plot : section.plots) plots += ToSvg(plot);
    html += "<figure>\n" + Tag("div", "plots", "\n" + plots) + "\n" +
            Tag("figcaption", "", Escape(section.plot_caption)) + "\n</figure>\n";
  }
  if (!section.pictures.empty()) {
    html += "<div class=\"pictures\">\n";
    for (const PictureCard& card : section.pictures) {
      html += Tag("figure", "card",
                  Tag("div", "pair",
                      PictureHtml(card.photograph, card.photograph_alt, "photograph") +
                          PictureHtml(card.depth_map, card.depth_alt, "depth map")) +
                      Tag("figcaption", "", Escape(card.caption))) +
              "\n";
    }
    html += "</div>\n";
  }
  return html + "</section>\n";
}

std::string MissingHtml(const std::vector<std::string>& missing) {
  if (missing.empty()) return {};
  std::string html = "<section>\n<h2>Missing and failed</h2>\n<ul>\n";
  for (const std::string& line : missing) html += Tag("li", "", Escape(line)) + "\n";
  return html + "</ul>\n</section>\n";
}

}  // namespace

Result<std::string> HtmlReport(const SubjectReport& subject) {
  const Page page = BuildPage(subject);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">\n";
  html += Tag("title", "", Escape(page.title + " - " + page.subtitle)) + "\n<style>" + std::string(detail::kHtmlStyle) +
          "</style>\n</head>\n<body>\n<main>\n" + HeaderHtml(page);
  for (const Section& section : page.sections) html += SectionHtml(section);
  if (page.sections.empty()) html += Tag("p", "note", "Nothing has been captured for this subject yet.") + "\n";
  html += MissingHtml(page.missing) + "<footer>\n";
  for (const std::string& line : page.footer) html += Tag("p", "", Escape(line)) + "\n";
  html += Tag("p", "", "Generated " + Escape(page.generated) + ".") + "\n";
  return html + "</footer>\n</main>\n</body>\n</html>\n";
}

}  // namespace striae::report
