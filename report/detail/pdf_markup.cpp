#include "report/detail/pdf_markup.h"

#include <string_view>

#include "report/detail/escape.h"

namespace striae::report::detail {
namespace {

constexpr std::string_view kNoBreak = "\u00a0";

std::string Unbroken(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == ' ') {
      result += kNoBreak;
    } else {
      result += c;
    }
  }
  return result;
}

std::string VerdictColour(Verdict verdict) {
  if (verdict == Verdict::kImproved) return "#1d7a55";
  return verdict == Verdict::kWorse ? "#b2402c" : "#5f6e77";
}

}  // namespace

std::string Span(const std::string& escaped, double size_pt, const std::string& weight, const std::string& colour) {
  std::string open = "<span size=\"" + std::to_string(static_cast<int>(size_pt * 1024)) + "\"";
  if (!weight.empty()) open += " weight=\"" + weight + "\"";
  if (!colour.empty()) open += " foreground=\"" + colour + "\"";
  return open + ">" + escaped + "</span>";
}

std::string FlagMarkup(const Cell& cell, double size_pt) {
  if (cell.flag.empty()) return {};
  return " <span background=\"#fdf3dc\" foreground=\"#8a5a00\" weight=\"600\" size=\"" +
         std::to_string(static_cast<int>(size_pt * 1024)) + "\">" + std::string(kNoBreak) + "flag" +
         std::string(kNoBreak) + Escape(cell.flag) + std::string(kNoBreak) + "</span>";
}

std::string SecondMarkup(const Cell& cell, double size_pt) {
  std::string markup;
  if (!cell.words.empty()) markup = Span(Escape(cell.words), size_pt);
  if (!cell.has_verdict) return markup;
  if (!markup.empty()) markup += "\n";
  markup += Span(Unbroken(std::string(ToString(cell.verdict))), size_pt, "600", VerdictColour(cell.verdict));
  std::string rest;
  if (!cell.change.empty()) rest += "  " + Unbroken(Escape(cell.change));
  if (!cell.limit.empty()) rest += "  " + Unbroken(Escape(cell.limit));
  if (!cell.verdict_reason.empty()) rest += "  " + Escape(cell.verdict_reason);
  return markup + Span(rest, size_pt, "", "#5f6e77");
}

std::string CellMarkup(const Cell& cell) {
  std::string markup = Span(Escape(cell.value), 8, "500") + FlagMarkup(cell, 6.6);
  const std::string second = SecondMarkup(cell, 6.7);
  return second.empty() ? markup : markup + "\n" + second;
}

}  // namespace striae::report::detail
