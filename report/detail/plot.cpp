#include "report/detail/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "report/format.h"

namespace striae::report::detail {
namespace {

constexpr Rgb8 kInk{38, 50, 56}, kGrey{112, 125, 133}, kGrid{228, 233, 236}, kZero{176, 186, 192},
    kWhite{255, 255, 255};
// Distinct for the common colour blindnesses, and each with a marker of its own.
constexpr std::array<Rgb8, 4> kColours = {{{38, 103, 163}, {181, 101, 29}, {46, 133, 110}, {122, 82, 148}}};
constexpr double kTop = 20, kBottom = 30, kLeft = 34, kRight = 12;
constexpr double kSmall = 7, kText = 8;
constexpr double kTwoSided95 = 1.96;

struct Range {
  double low = 0, high = 1;
};

struct Frame {
  double left, right, top, bottom;
  Range place, value;
  [[nodiscard]] double X(double p) const { return left + (p - place.low) / (place.high - place.low) * (right - left); }
  [[nodiscard]] double Y(double v) const {
    return bottom - (v - value.low) / (value.high - value.low) * (bottom - top);
  }
};

Rgb8 Tint(Rgb8 colour) {
  const auto mix = [](std::uint8_t c) { return static_cast<std::uint8_t>(255 - (255 - c) * 11 / 100); };
  return {mix(colour.r), mix(colour.g), mix(colour.b)};
}

/// 1, 2 or 5 times a power of ten, so that about `count` steps span `span`.
double NiceStep(double span, int count) {
  const double raw = span / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10 * power;
}

Range ValueRange(const std::vector<PlotLine>& lines) {
  Range range{0, 0};
  for (const PlotLine& line : lines) {
    for (const PlotPoint& p : line.points) {
      range.low = std::min(range.low, p.value - kTwoSided95 * p.uncertainty);
      range.high = std::max(range.high, p.value + kTwoSided95 * p.uncertainty);
    }
  }
  if (range.high - range.low <= 0) range.high = 1;
  const double step = NiceStep(range.high - range.low, 4);
  return {std::floor(range.low / step + 1e-9) * step, std::ceil(range.high / step - 1e-9) * step};
}

struct Tick {
  double day = 0;
  std::string visits;
};

/// Where on the axis each visit stands: at its day. Visits that all fall on one day would hide each other and stand
/// side by side, each labelled with that day.
std::vector<PlotLine> WithPlaces(std::vector<PlotLine> lines) {
  std::vector<std::string> visits;
  std::set<double> days;
  for (const PlotLine& line : lines) {
    for (const PlotPoint& p : line.points) {
      days.insert(p.day);
      if (std::find(visits.begin(), visits.end(), p.visit) == visits.end()) visits.push_back(p.visit);
    }
  }
  for (PlotLine& line : lines) {
    for (PlotPoint& p : line.points) {
      const auto index = std::find(visits.begin(), visits.end(), p.visit) - visits.begin();
      p.place = days.size() > 1 ? p.day : static_cast<double>(index);
    }
  }
  return lines;
}

/// By place, over all lines.
std::map<double, Tick> Ticks(const std::vector<PlotLine>& lines) {
  std::map<double, Tick> ticks;
  for (const PlotLine& line : lines) {
    for (const PlotPoint& p : line.points) {
      Tick& tick = ticks[p.place];
      tick.day = p.day;
      if (tick.visits.find(p.visit) == std::string::npos) tick.visits += (tick.visits.empty() ? "" : ", ") + p.visit;
    }
  }
  return ticks;
}

Range PlaceRange(const std::map<double, Tick>& ticks) {
  if (ticks.empty()) return {0, 1};
  const double low = ticks.begin()->first, high = ticks.rbegin()->first;
  const double margin = high > low ? 0.06 * (high - low) : 1;
  return {low - margin, high + margin};
}

void DrawAxes(Drawing& drawing, const Frame& frame, const std::map<double, Tick>& ticks) {
  const double step = NiceStep(frame.value.high - frame.value.low, 4);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const int count = static_cast<int>(std::lround((frame.value.high - frame.value.low) / step));
  for (int i = 0; i <= count; ++i) {
    const double value = frame.value.low + i * step;
    const double y = frame.Y(value);
    const bool zero = std::abs(value) < 1e-9 * step + 1e-300 || std::abs(value) < 1e-6 * step;
    drawing.Line({{frame.left, y}, {frame.right, y}}, zero ? 0.8 : 0.5, zero ? kZero : kGrid);
    drawing.Text({frame.left - 5, y + 2.5}, kSmall, FormatNumber(value, decimals), kGrey, Anchor::kEnd);
  }
  double free_from = -1e9;
  for (const auto& [place, tick] : ticks) {
    const double x = frame.X(place);
    drawing.Line({{x, frame.bottom}, {x, frame.bottom + 3}}, 0.6, kZero);
    if (x < free_from) continue;
    drawing.Text({x, frame.bottom + 12}, kSmall, "day " + FormatNumber(tick.day, 0), kGrey, Anchor::kMiddle);
    drawing.Text({x, frame.bottom + 21}, kSmall, tick.visits, kInk, Anchor::kMiddle, true);
    free_from = x + 30;
  }
}

void DrawMarker(Drawing& drawing, Point at, std::size_t style, Rgb8 colour, bool flagged) {
  const Rgb8 fill = flagged ? kWhite : colour;
  const double r = 2.2;
  if (style % 3 == 1) {
    drawing.Polygon({{at.x - r, at.y - r}, {at.x + r, at.y - r}, {at.x + r, at.y + r}, {at.x - r, at.y + r}}, fill,
                    colour, 1.2);
  } else if (style % 3 == 2) {
    drawing.Polygon({{at.x, at.y - 1.25 * r}, {at.x + 1.2 * r, at.y + r}, {at.x - 1.2 * r, at.y + r}}, fill, colour,
                    1.2);
  } else {
    drawing.Circle(at, r, fill, colour, 1.2);
  }
}

void DrawBand(Drawing& drawing, const Frame& frame, const PlotLine& line, Rgb8 colour) {
  if (line.points.size() < 2 || !(line.points[0].uncertainty > 0)) return;
  const double half = kTwoSided95 * std::sqrt(2.0) * line.points[0].uncertainty;
  const double top = std::max(frame.top, frame.Y(line.points[0].value + half));
  const double bottom = std::min(frame.bottom, frame.Y(line.points[0].value - half));
  drawing.Polygon({{frame.left, top}, {frame.right, top}, {frame.right, bottom}, {frame.left, bottom}}, Tint(colour),
                  colour, 0);
}

void DrawLine(Drawing& drawing, const Frame& frame, const PlotLine& line, std::size_t style) {
  const Rgb8 colour = kColours[style % kColours.size()];
  std::vector<Point> path;
  for (const PlotPoint& p : line.points) path.push_back({frame.X(p.place), frame.Y(p.value)});
  if (path.size() > 1) drawing.Line(path, 1.2, colour);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PlotPoint& p = line.points[i];
    const double x = path[i].x;
    const double high = frame.Y(p.value + kTwoSided95 * p.uncertainty);
    const double low = frame.Y(p.value - kTwoSided95 * p.uncertainty);
    drawing.Line({{x, high}, {x, low}}, 0.9, colour);
    drawing.Line({{x - 2.5, high}, {x + 2.5, high}}, 0.9, colour);
    drawing.Line({{x - 2.5, low}, {x + 2.5, low}}, 0.9, colour);
    DrawMarker(drawing, path[i], style, colour, p.flagged);
  }
}

/// The lines' names at their right ends, pushed apart where they would touch.
void DrawNames(Drawing& drawing, const Frame& frame, const std::vector<PlotLine>& lines, std::size_t first_colour) {
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return lines[i].points.empty(); });
  const auto end_y = [&](std::size_t i) { return frame.Y(lines[i].points.back().value); };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return end_y(a) < end_y(b); });
  double lowest = -1e9;
  for (const std::size_t i : order) {
    const double y = std::max(end_y(i), lowest + 10);
    lowest = y;
    drawing.Text({frame.right + 6, y + 2.7}, kText, lines[i].label, kColours[(first_colour + i) % kColours.size()],
                 Anchor::kStart, true);
  }
}

std::string Describe(const std::string& title, const std::string& unit, const std::vector<PlotLine>& lines) {
  std::string text = title + " over the days since the first visit";
  for (const PlotLine& line : lines) {
    text += ". " + line.label + ":";
    for (const PlotPoint& p : line.points) {
      text += " " + p.visit + " (day " + FormatNumber(p.day, 0) + ") " + FormatWithUncertainty(p.value, p.uncertainty) +
              " " + unit + (p.flagged ? ", flagged;" : ";");
    }
    text.pop_back();
  }
  return text;
}

}  // namespace

Drawing DrawPlot(const std::string& title, const std::string& unit, const std::vector<PlotLine>& given,
                 std::size_t first_colour, double width_pt, double height_pt) {
  const std::vector<PlotLine> lines = WithPlaces(given);
  Drawing drawing;
  drawing.width = width_pt;
  drawing.height = height_pt;
  drawing.description = Describe(title, unit, lines);
  const bool names = lines.size() > 1;
  const auto ticks = Ticks(lines);
  const Frame frame{
      kLeft, width_pt - (names ? 52 : kRight), kTop, height_pt - kBottom, PlaceRange(ticks), ValueRange(lines)};
  drawing.Text({0, 10}, 9, title + (unit.empty() ? "" : " / " + unit), kInk, Anchor::kStart, true);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    DrawBand(drawing, frame, lines[i], kColours[(first_colour + i) % kColours.size()]);
  }
  DrawAxes(drawing, frame, ticks);
  for (std::size_t i = 0; i < lines.size(); ++i) DrawLine(drawing, frame, lines[i], first_colour + i);
  if (names) DrawNames(drawing, frame, lines, first_colour);
  return drawing;
}

}  // namespace striae::report::detail
