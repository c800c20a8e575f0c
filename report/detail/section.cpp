#include "report/detail/section.h"

#include <algorithm>
#include <map>
#include <utility>

#include "report/detail/plot.h"
#include "report/format.h"
#include "report/quantity.h"

namespace striae::report::detail {
namespace {

constexpr double kFullWidthPt = 531, kGapPt = 18, kPlotHeightPt = 112;

/// Letters for the distinct reasons of a section: a, b, ... z, aa, ab ...
class Flags {
 public:
  std::string LetterFor(const std::string& reason) {
    const auto [at, added] = letters_.try_emplace(reason, "");
    if (added) at->second = Letter(letters_.size() - 1);
    return at->second;
  }

 private:
  static std::string Letter(std::size_t index) {
    std::string letter(1, static_cast<char>('a' + index % 26));
    return index < 26 ? letter : Letter(index / 26 - 1) + letter;
  }
  std::map<std::string, std::string> letters_;
};

std::string DayText(std::int64_t day) { return "day " + FormatNumber(static_cast<double>(day), 0); }

void FillChange(Cell& cell, const Reading& first, const Reading& now, Better better) {
  const Comparison comparison = Compare(first, now, better);
  if (comparison.change) {
    const int decimals = DecimalsFor(comparison.change_uncertainty);
    cell.change = FormatSigned(*comparison.change, decimals);
    if (comparison.percent) cell.change += " (" + FormatPercent(*comparison.percent) + ")";
    if (comparison.limit > 0 && comparison.reason.empty())
      cell.limit = "limit " + FormatNumber(comparison.limit, DecimalsFor(comparison.limit));
  }
  cell.has_verdict = true;
  cell.verdict = comparison.verdict;
  cell.verdict_reason = comparison.reason;
}

Cell MakeCell(const Series& series, const SeriesColumn& column, const std::string& name, Better better, Flags& flags) {
  Cell cell;
  const SeriesColumn* first = series.First(name);
  const auto at = column.values.find(name);
  if (at == column.values.end()) {
    cell.value = "no value";
    return cell;
  }
  const Reading& now = at->second.reading;
  cell.value = FormatWithUncertainty(now.value, now.uncertainty);
  cell.words = InWords(name, now.value, now.uncertainty);
  if (now.flagged) cell.flag = flags.LetterFor(at->second.reason);
  if (first != &column) FillChange(cell, first->values.at(name).reading, now, better);
  return cell;
}

/// Reasons of the column's flags, in the order of their letters.
std::vector<std::string> FlagNotes(const SeriesColumn& column, Flags& flags) {
  std::map<std::string, std::string> by_letter;
  for (const auto& [name, value] : column.values) {
    if (value.reading.flagged) by_letter[flags.LetterFor(value.reason)] = value.reason;
  }
  std::vector<std::string> notes;
  notes.reserve(by_letter.size());
  for (const auto& [letter, reason] : by_letter) {
    std::string note = "flag ";
    note.append(letter).append(": ").append(reason);
    notes.push_back(std::move(note));
  }
  return notes;
}

std::vector<Drawing> MakePlots(const Series& series, HeadGoal goal) {
  std::vector<std::string> units;  // one panel a unit
  std::map<std::string, std::vector<std::string>> names_of;
  for (const std::string& name : series.names) {
    if (!DescribeQuantity(name, goal).headline) continue;
    const std::string unit = series.First(name)->values.at(name).reading.unit;
    if (!names_of.contains(unit)) units.push_back(unit);
    names_of[unit].push_back(name);
  }
  std::vector<Drawing> plots;
  const auto panels = static_cast<double>(units.size());
  std::size_t colour = 0;
  for (const std::string& unit : units) {
    std::vector<PlotLine> lines;
    for (const std::string& name : names_of[unit]) {
      PlotLine line{DescribeQuantity(name, goal).label, {}};
      for (const SeriesColumn& column : series.columns) {
        const auto at = column.values.find(name);
        if (at == column.values.end() || at->second.reading.unit != unit) continue;
        const Reading& r = at->second.reading;
        line.points.push_back({static_cast<double>(column.day), r.value, r.uncertainty, r.flagged, column.visit->name});
      }
      lines.push_back(line);
    }
    const std::string title = lines.size() > 1 ? "Head angles" : lines.front().label;
    plots.push_back(
        DrawPlot(title, UnitText(unit), lines, colour, (kFullWidthPt - kGapPt * (panels - 1)) / panels, kPlotHeightPt));
    colour += lines.size();
  }
  return plots;
}

std::vector<PictureCard> MakePictures(const Series& series) {
  std::vector<PictureCard> cards;
  for (const SeriesColumn& column : series.columns) {
    const auto has_picture = [](const CaptureEntry* c) { return !c->photograph.empty() || !c->depth_map.empty(); };
    const auto at = std::find_if(column.captures.begin(), column.captures.end(), has_picture);
    if (at == column.captures.end()) continue;
    PictureCard card;
    card.caption = VisitText(*column.visit) + " · " + DayText(column.day);
    card.photograph_alt = "Photograph, " + series.title + ", " + card.caption;
    card.depth_alt = "Depth map in mm with colour bar, " + series.title + ", " + card.caption;
    card.photograph = (*at)->photograph;
    card.depth_map = (*at)->depth_map;
    cards.push_back(std::move(card));
  }
  return cards;
}

void AddSectionNotes(Section& section, const Series& series, HeadGoal goal) {
  std::map<const SeriesColumn*, std::vector<std::string>> later_first;
  for (const std::string& name : series.names) {
    const SeriesColumn* first = series.First(name);
    if (first != &series.columns.front()) later_first[first].push_back(DescribeQuantity(name, goal).label);
  }
  for (const auto& [column, labels] : later_first) {
    std::string list;
    for (const std::string& label : labels) list += (list.empty() ? "" : ", ") + label;
    section.notes.push_back("No value at " + series.columns.front().visit->name + "; changes are against " +
                            column->visit->name + " for: " + list + ".");
  }
}

}  // namespace

std::string VisitText(const VisitEntry& visit) { return visit.name + " · " + visit.date.ToString(); }

Section MakeSection(const Series& series, HeadGoal goal) {
  Section section;
  section.title = series.title;
  Flags flags;
  for (const std::string& name : series.names) {
    const Quantity quantity = DescribeQuantity(name, goal);
    Row row{quantity.label, UnitText(series.First(name)->values.at(name).reading.unit), {}};
    for (const SeriesColumn& column : series.columns) {
      row.cells.push_back(MakeCell(series, column, name, quantity.better, flags));
    }
    if (quantity.headline) {
      const SeriesColumn* last = series.Last(name);
      const auto index = static_cast<std::size_t>(last - series.columns.data());
      section.headlines.push_back(
          {quantity.label, row.unit, last->visit->name + ", " + DayText(last->day), row.cells[index]});
    }
    section.rows.push_back(std::move(row));
  }
  for (const SeriesColumn& column : series.columns) {
    Column head{column.visit->name, column.visit->date.ToString(), DayText(column.day), column.visit->status,
                FlagNotes(column, flags)};
    head.notes.insert(head.notes.end(), column.notes.begin(), column.notes.end());
    section.columns.push_back(std::move(head));
  }
  AddSectionNotes(section, series, goal);
  section.plots = MakePlots(series, goal);
  if (!section.plots.empty()) {
    section.plot_caption =
        "Bars: 95 % (± 1.96 u). Shaded: within error of the first value. Hollow marks: flagged. Lines join "
        "measured visits only; nothing is interpolated.";
  }
  section.pictures = MakePictures(series);
  return section;
}

}  // namespace striae::report::detail
