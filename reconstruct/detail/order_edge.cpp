// The grating's own edge: where only the stripes end.
#include <cmath>
#include <tuple>
#include <utility>

#include "reconstruct/detail/order_lines.h"
#include "reconstruct/order.h"

namespace striae::reconstruct {
namespace {

using detail::Lines;
using detail::MedianOf;

constexpr double kLargestScatter = 0.13;  ///< stripes; OPTICS measured 0.02 to 0.13 on true edges
constexpr double kLeastShare = 0.2;
constexpr int kFewestLines = 40;            ///< of about a thousand over the picture
constexpr double kLargestModulation = 0.3;  ///< beyond the edge, against the plateau's
constexpr double kGhost = 0.004;            ///< of the plateau: amplitude that the window's side lobes leave
constexpr double kLeastAmbient = 0.006;     ///< background beyond the edge, against the plateau's
/// Where what only the room lights ends in turn, the window makes a ghost of the carrier out of that step: at most the
/// integral of the Hann window over f / (pi f) from 0.3 to 1.7 of the carrier, a quarter of the step's height.
constexpr double kOutline = 0.3;
constexpr double kLargestBeyond = 0.03;  ///< share of the region's lines on which it goes on past its edge

/// What one line shows at one end of a region.
struct LineEnd {
  double last = 0;   ///< relative order of the outermost pixel
  double order = 0;  ///< where the amplitude falls to half
  bool votes = false;
  int line = 0, crossing = 0;      ///< where that is
  double plateau = 0, beyond = 0;  ///< amplitude inside, background outside
};

/// Means along a line over positions from `from`, going by `step`.
struct Mean {
  double amplitude = 0, background = 0;
  int count = 0;
};

class EndReader {
 public:
  explicit EndReader(const PhaseResult& phase) : phase_(phase), lines_(phase), period_(phase.carrier_period_px) {}

  /// The end at `end`; `inwards` is +1 at the low orders and -1 at the high ones.
  [[nodiscard]] LineEnd Read(int line, int end, int inwards) const {
    LineEnd found;
    found.last = lines_.Order(line, end);
    const double plateau = Plateau(line, end, inwards);
    const int start = end + inwards * static_cast<int>(period_),
              deeper = start + inwards * static_cast<int>(2 * period_);
    if (!lines_.Has(deeper) || plateau <= 0) return found;
    const double at_start = lines_.Order(line, start);
    const double slope = (at_start - lines_.Order(line, deeper)) / (start - deeper);
    if (!std::isfinite(at_start) || !std::isfinite(slope)) return found;
    const auto crossing = Crossing(line, start, inwards, plateau / 2);
    if (!crossing) return found;
    found.order = at_start + slope * (*crossing - start);
    found.line = line;
    found.crossing = static_cast<int>(std::lround(*crossing));
    found.plateau = plateau;
    found.votes = OnlyTheStripesEnd(start, inwards, found);
    return found;
  }

  /// A wall behind a body that ends here: beside the end it carries stripes, so what lies beyond may be the body's
  /// shadow on it; or it looks like what lies beyond, and its own stripes begin elsewhere. `side` is -1 or +1, from the
  /// outermost line of the end outwards.
  [[nodiscard]] bool IsWall(const LineEnd& end, int side, int inwards) const {
    constexpr double kAlike = 0.12, kStriped = 0.1;
    int walls = 0;
    for (const double away : {1.5, 2.5, 3.5}) {
      const int line = end.line + side * static_cast<int>(std::lround(away * period_));
      if (line < 0 || line >= lines_.count()) continue;
      const Mean out = Beyond(line, end.crossing, inwards);
      if (out.count >= period_ / 5 && Striped(line, end.crossing, inwards)) {
        ++walls;
        continue;
      }
      if (out.count < period_ / 5 || std::abs(std::log(out.background / end.beyond)) > kAlike) continue;
      const int from = end.crossing + inwards * static_cast<int>(period_),
                to = end.crossing + inwards * static_cast<int>(3 * period_);
      if (MeanOver(line, from, to).amplitude > kStriped * end.plateau) continue;
      for (int at = to; lines_.Has(at); at += inwards * std::max(1, static_cast<int>(period_ / 2))) {
        if (lines_.At(phase_.mask, line, at) == 0) continue;
        ++walls;
        break;
      }
    }
    return walls >= 2;
  }

 private:
  [[nodiscard]] Mean Beyond(int line, int crossing, int inwards) const {
    return MeanOver(line, crossing - inwards * 1.75 * period_, crossing - inwards * 3.5 * period_);
  }

  /// Most of what `Beyond` looks at is within the mask.
  [[nodiscard]] bool Striped(int line, int crossing, int inwards) const {
    int striped = 0, count = 0;
    for (double away = 1.75; away <= 3.5; away += 0.25) {
      const int at = crossing - inwards * static_cast<int>(away * period_);
      if (!lines_.Has(at)) continue;
      ++count;
      striped += lines_.At(phase_.mask, line, at) != 0 ? 1 : 0;
    }
    return 2 * striped > count;
  }

  /// Median amplitude over a few periods from the end inwards: what the stripes fall from.
  [[nodiscard]] double Plateau(int line, int end, int inwards) const {
    std::vector<double> values;
    for (int i = 1; i <= static_cast<int>(4 * period_); ++i) {
      const int position = end + inwards * i;
      if (!lines_.Has(position)) break;
      values.push_back(lines_.At(phase_.amplitude, line, position));
    }
    return values.empty() ? 0 : MedianOf(values);
  }

  /// Where the amplitude falls to `half`, walking outwards; linear between the two pixels around it.
  [[nodiscard]] std::optional<double> Crossing(int line, int start, int inwards, double half) const {
    const int furthest = start - inwards * static_cast<int>(2.5 * period_);
    for (int at = start; lines_.Has(at) && at != furthest; at -= inwards) {
      const double outside = lines_.At(phase_.amplitude, line, at);
      if (outside > half) continue;
      const double inside = lines_.At(phase_.amplitude, line, at + inwards);
      return at + inwards * (half - outside) / std::max(1e-12, inside - outside);
    }
    return std::nullopt;
  }

  [[nodiscard]] Mean MeanOver(int line, double from, double to) const {
    Mean mean;
    for (int at = static_cast<int>(std::ceil(std::min(from, to))); at <= std::max(from, to); ++at) {
      if (!lines_.Has(at)) continue;
      mean.amplitude += lines_.At(phase_.amplitude, line, at);
      mean.background += lines_.At(phase_.background, line, at);
      ++mean.count;
    }
    if (mean.count > 0) mean.amplitude /= mean.count, mean.background /= mean.count;
    return mean;
  }

  /// Room light still shows the surface beyond, without stripes there or anywhere further out on the line.
  [[nodiscard]] bool OnlyTheStripesEnd(int start, int inwards, LineEnd& end) const {
    const auto [line, crossing, plateau] = std::tuple(end.line, end.crossing, end.plateau);
    const Mean out = Beyond(line, crossing, inwards);
    const Mean in = MeanOver(line, start, start + inwards * 2.0 * period_);
    end.beyond = out.background;
    if (out.count < period_ / 5 || in.count == 0 || in.background <= 0) return false;
    const double ambient = out.background / in.background;
    const double modulation = out.amplitude / std::max(1e-9, out.background) / (in.amplitude / in.background);
    if (ambient < kLeastAmbient) return false;
    if (modulation > kLargestModulation && out.amplitude > kGhost * plateau) return false;
    const int step = std::max(1, static_cast<int>(period_ / 2));
    for (int at = crossing - inwards * static_cast<int>(3 * period_); lines_.Has(at); at -= inwards * step) {
      if (lines_.At(phase_.mask, line, at) == 0) continue;
      if (lines_.At(phase_.amplitude, line, at) > kOutline * out.background) return false;
    }
    return true;
  }

  const PhaseResult& phase_;
  Lines lines_;
  double period_;
};

/// Reduces what the lines show at one end to an edge, if it is one. `outwards` is -1 at the low orders.
std::optional<GratingEdge> JudgeEdge(const std::vector<LineEnd>& ends, int outwards, const EndReader& reader) {
  std::vector<double> orders;
  for (const LineEnd& end : ends) {
    if (end.votes) orders.push_back(end.order);
  }
  if (static_cast<int>(orders.size()) < kFewestLines) return std::nullopt;
  const double median = MedianOf(orders);
  // The lines that belong to the edge: the others end at the subject's own border.
  std::vector<double> near;
  const LineEnd *first = nullptr, *last = nullptr;
  for (const LineEnd& end : ends) {
    if (!end.votes || std::abs(end.order - median) >= 0.5) continue;
    near.push_back(end.order);
    if (first == nullptr) first = &end;
    last = &end;
  }
  const double share = static_cast<double>(near.size()) / static_cast<double>(ends.size());
  if (static_cast<int>(near.size()) < kFewestLines || share < kLeastShare) return std::nullopt;
  const double center = MedianOf(near);
  std::vector<double> deviations;
  for (const double order : near) deviations.push_back(std::abs(order - center));
  const double scatter = 1.4826 * MedianOf(deviations);
  const auto beyond =
      std::count_if(ends.begin(), ends.end(), [&](const LineEnd& end) { return outwards * (end.last - center) > 0.5; });
  if (scatter > kLargestScatter) return std::nullopt;
  if (static_cast<double>(beyond) > kLargestBeyond * static_cast<double>(ends.size())) return std::nullopt;
  if (reader.IsWall(*first, -1, -outwards) || reader.IsWall(*last, +1, -outwards)) return std::nullopt;
  return GratingEdge{center, scatter, static_cast<int>(near.size()), share};
}

}  // namespace

std::vector<RegionEdges> FindGratingEdges(const PhaseResult& phase, int regions) {
  const Lines lines(phase);
  const int count = (lines.count() + lines.Step() - 1) / lines.Step();
  // First and last pixel of every region on every line: only the outermost ends can be the grating's.
  const auto slot = [&](int region, int line) {
    return static_cast<std::size_t>(region) * static_cast<std::size_t>(count) +
           static_cast<std::size_t>(line / lines.Step());
  };
  std::vector<std::pair<int, int>> spans(static_cast<std::size_t>(regions) * static_cast<std::size_t>(count), {-1, -1});
  // An eighth of a stripe is sought at a time, and the end then found to the pixel.
  const int stride = std::max(1, static_cast<int>(phase.carrier_period_px / 8));
  const auto outermost = [&](int line, int position, int outwards) {
    const int region = lines.Region(line, position);
    for (int k = 1; k < stride && lines.Has(position + outwards); ++k) {
      if (lines.Region(line, position + outwards) != region) break;
      position += outwards;
    }
    return position;
  };
  lines.ForEachPixel(regions, stride, [&](int line, int position, int region) {
    auto& [first, last] = spans[slot(region, line)];
    if (first < 0) first = position;
    last = position;
  });
  const EndReader reader(phase);
  std::vector<RegionEdges> edges;
  for (int region = 0; region < regions; ++region) {
    std::vector<int> with;  // lines that the region lies on
    for (int line = 0; line < lines.count(); line += lines.Step()) {
      if (spans[slot(region, line)].first >= 0) with.push_back(line);
    }
    std::vector<LineEnd> low(with.size()), high(with.size());
    detail::ParallelLines(static_cast<int>(with.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      const auto& [first, last] = spans[slot(region, with[i])];
      low[i] = reader.Read(with[i], outermost(with[i], first, -1), +1);
      high[i] = reader.Read(with[i], outermost(with[i], last, +1), -1);
    });
    edges.push_back({JudgeEdge(low, -1, reader), JudgeEdge(high, +1, reader)});
  }
  return edges;
}

}  // namespace striae::reconstruct
