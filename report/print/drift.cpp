#include "report/print/drift.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/print/detail/pdf_file.h"

namespace striae::report {
namespace {

constexpr Rgb8 kInk{38, 50, 56}, kGrey{112, 125, 133}, kGrid{228, 233, 236}, kBand{226, 239, 232},
    kLimit{150, 180, 165}, kGood{38, 120, 90}, kBad{190, 50, 40};
constexpr double kLeft = 52, kRight = 16, kTop = 34, kPanel = 150, kBetween = 46, kBottom = 26;
constexpr double kSmall = 8, kText = 9;
constexpr double kMsPerDay = 86'400'000;

/// 1, 2 or 5 times a power of ten, so that about `count` steps span `span`.
double NiceStep(double span, int count) {
  const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10 * power;
}

struct Axis {
  double low = 0, high = 1, at_low = 0, at_high = 1;
  [[nodiscard]] double At(double value) const { return at_low + (value - low) / (high - low) * (at_high - at_low); }
};

double DayOf(const UtcTime& time) { return static_cast<double>(time.unix_ms) / kMsPerDay; }

/// All panels share the days: from the first to the last check, a little wider; at least two weeks.
Axis Days(const std::vector<DriftPanel>& panels, double width) {
  double first = INFINITY, last = -INFINITY;
  for (const DriftPanel& panel : panels) {
    for (const DriftPoint& p : panel.points) {
      first = std::min(first, DayOf(p.at));
      last = std::max(last, DayOf(p.at));
    }
  }
  const double margin = std::max(0.04 * (last - first), (14 - (last - first)) / 2);
  return {std::floor(first - margin), std::ceil(last + margin), kLeft, width - kRight};
}

/// From 0, or from below where a value is negative; the tolerance with some room is always in view.
Axis Values(const DriftPanel& panel, double top) {
  double low = 0, high = 0;
  for (const DriftPoint& p : panel.points) {
    low = std::min({low, p.value, p.value < 0 ? -p.limit : 0.0});
    high = std::max({high, p.value, p.limit});
  }
  if (low < 0) high = std::max(high, -low), low = std::min(low, -high);
  if (!(high > low)) high = low + 1;
  const double step = NiceStep(high - low, 5);
  return {std::floor(low / step - 0.2) * step * (low < 0 ? 1 : 0), std::ceil(high / step + 0.2) * step, top + kPanel,
          top};
}

void DrawBand(Drawing& drawing, const DriftPanel& panel, const Axis& days, const Axis& values) {
  // Each check's limit holds from half way to the one before until half way to the next.
  for (std::size_t i = 0; i < panel.points.size(); ++i) {
    const DriftPoint& p = panel.points[i];
    const double day = DayOf(p.at);
    const double from = i == 0 ? days.low : (DayOf(panel.points[i - 1].at) + day) / 2;
    const double to = i + 1 == panel.points.size() ? days.high : (day + DayOf(panel.points[i + 1].at)) / 2;
    const double left = days.At(from), right = days.At(to);
    const double upper = values.At(p.limit), lower = values.At(std::max(-p.limit, values.low));
    drawing.Polygon({{left, upper}, {right, upper}, {right, lower}, {left, lower}}, kBand, kBand, 0);
    drawing.Line({{left, upper}, {right, upper}}, 0.8, kLimit);
    if (values.low < 0) drawing.Line({{left, lower}, {right, lower}}, 0.8, kLimit);
  }
}

void DrawAxes(Drawing& drawing, const DriftPanel& panel, const Axis& days, const Axis& values) {
  const double step = NiceStep(values.high - values.low, 5);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  for (double v = std::ceil(values.low / step - 1e-9) * step; v <= values.high + 1e-9 * step; v += step) {
    const double y = values.At(v), shown = std::abs(v) < 1e-9 * step ? 0 : v;
    drawing.Line({{kLeft, y}, {days.at_high, y}}, shown == 0 ? 0.8 : 0.4, shown == 0 ? kGrey : kGrid);
    drawing.Text({kLeft - 5, y + 3}, kSmall, fmt::format("{:.{}f}", shown, decimals), kInk, Anchor::kEnd);
  }
  drawing.Line({{kLeft, values.at_low}, {kLeft, values.at_high}}, 0.8, kGrey);
  const double day_step = std::max(1.0, NiceStep(days.high - days.low, 6));
  for (double day = std::ceil(days.low / day_step) * day_step; day <= days.high; day += day_step) {
    const double x = days.At(day);
    drawing.Line({{x, values.at_low}, {x, values.at_low + 3}}, 0.6, kGrey);
    const std::string date = Date::Of({static_cast<std::int64_t>(day * kMsPerDay)}).ToString();
    drawing.Text({x, values.at_low + 12}, kSmall, date, kInk, Anchor::kMiddle);
  }
  drawing.Text({kLeft, values.at_high - 8}, kText, panel.title + " (" + panel.unit + ")", kInk, Anchor::kStart, true);
}

void DrawPoints(Drawing& drawing, const DriftPanel& panel, const Axis& days, const Axis& values) {
  std::vector<Point> line;
  for (const DriftPoint& p : panel.points) line.push_back({days.At(DayOf(p.at)), values.At(p.value)});
  if (line.size() > 1) drawing.Line(line, 1, kGrey);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto [x, y] = line[i];
    if (panel.points[i].passed) {
      drawing.Circle({x, y}, 3, kGood, kGood, 0);
    } else {
      drawing.Line({{x - 4, y - 4}, {x + 4, y + 4}}, 1.8, kBad);
      drawing.Line({{x - 4, y + 4}, {x + 4, y - 4}}, 1.8, kBad);
    }
  }
}

}  // namespace

Drawing DrawDrift(const std::string& title, const std::vector<DriftPanel>& panels, double width_pt) {
  std::vector<DriftPanel> shown;
  std::copy_if(panels.begin(), panels.end(), std::back_inserter(shown),
               [](const DriftPanel& panel) { return !panel.points.empty(); });
  Drawing drawing;
  drawing.width = width_pt;
  drawing.height = kTop + static_cast<double>(shown.size()) * (kPanel + kBetween) + kBottom;
  drawing.description = title;
  drawing.Text({kLeft, 16}, 11, title, kInk, Anchor::kStart, true);
  if (shown.empty()) return drawing;
  const Axis days = Days(shown, width_pt);
  double top = kTop + 14;
  for (const DriftPanel& panel : shown) {
    const Axis values = Values(panel, top);
    DrawBand(drawing, panel, days, values);
    DrawAxes(drawing, panel, days, values);
    DrawPoints(drawing, panel, days, values);
    top += kPanel + kBetween;
  }
  const double foot = drawing.height - 10;
  drawing.Circle({kLeft + 4, foot - 3}, 3, kGood, kGood, 0);
  drawing.Text({kLeft + 12, foot}, kSmall, "passed", kInk);
  drawing.Line({{kLeft + 52, foot - 7}, {kLeft + 60, foot + 1}}, 1.8, kBad);
  drawing.Line({{kLeft + 52, foot + 1}, {kLeft + 60, foot - 7}}, 1.8, kBad);
  drawing.Text({kLeft + 66, foot}, kSmall, "check failed", kInk);
  drawing.Polygon({{kLeft + 124, foot - 7}, {kLeft + 138, foot - 7}, {kLeft + 138, foot + 1}, {kLeft + 124, foot + 1}},
                  kBand, kLimit, 0.6);
  drawing.Text({kLeft + 143, foot}, kSmall, "tolerance", kInk);
  return drawing;
}

Result<std::vector<std::uint8_t>> PdfDrawing(const Drawing& drawing, const std::string& title, const UtcTime& made_at) {
  const detail::PdfFile file{title, drawing.width / detail::kPointsPerMm, drawing.height / detail::kPointsPerMm,
                             made_at};
  return detail::WritePdf(file, 1, [&](cairo_t* context, int /*page*/) {
    cairo_scale(context, 1 / detail::kPointsPerMm, 1 / detail::kPointsPerMm);
    detail::Paint(context, drawing, 0, 0);
  });
}

}  // namespace striae::report
