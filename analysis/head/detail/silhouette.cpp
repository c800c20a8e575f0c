#include "analysis/head/detail/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::head::detail {
namespace {

constexpr double kGapMm = 25;           // eyes, nostrils and stripes lost to shadow do not split a silhouette
constexpr double kShoulderRatio = 1.6;  // shoulder breadth over head breadth is 2.4-3 in adults, 1.8 in small children
constexpr double kWidestHeadMm = 160;   // what is wider is hair (head breadth of adults: 155 +- 6 mm)
constexpr double kWidestHairMm = 300;
constexpr double kChinStripMm = 25;  // to either side of the midline: a chin is about 50 mm wide
constexpr double kLeastChinDropMm =
    18;  // a nose stands 15 to 20 mm before the lip, a chin 40 and more before the throat
constexpr double kCrownToNeckMm = 120;  // at least, even where the light ends on the forehead
constexpr double kNone = -std::numeric_limits<double>::infinity();

std::vector<Run> RunsOf(const std::vector<Silhouette::Point>& bin) {
  std::vector<Run> runs;
  for (const auto& p : bin) {
    if (runs.empty() || p.right - runs.back().to > kGapMm) runs.push_back({p.right, p.right});
    runs.back().to = p.right;
  }
  return runs;
}

/// The run that continues `above`: the one that overlaps it most, or none.
std::optional<Run> Continue(const std::vector<Run>& runs, const Run& above) {
  std::optional<Run> best;
  double most = 0;
  for (const Run& run : runs) {
    const double overlap = std::min(run.to, above.to) - std::max(run.from, above.from);
    if (overlap > most) {
      most = overlap;
      best = run;
    }
  }
  return best;
}

/// The front of the body along its midline in every bin of the outline; kNone where nothing is measured.
std::vector<double> Midline(const Silhouette& s, const Outline& outline, double middle) {
  std::vector<double> front;
  for (std::size_t i = 0; i < outline.runs.size(); ++i) {
    std::vector<double> strip;
    for (const auto& p : s.bins[outline.first + i]) {
      if (std::abs(p.right - middle) <= kChinStripMm) strip.push_back(p.forward);
    }
    if (strip.size() < 5) {
      front.push_back(kNone);
      continue;
    }
    const auto place = strip.begin() + static_cast<std::ptrdiff_t>(strip.size() * 9 / 10);
    std::nth_element(strip.begin(), place, strip.end());
    front.push_back(*place);
  }
  return front;
}

std::size_t Bins(double mm) { return static_cast<std::size_t>(mm / kBinMm); }

/// Where the midline falls back most: from the chin to the throat.
void FindChin(const std::vector<double>& front, std::size_t from, std::size_t to, Landmarks& found) {
  for (std::size_t i = from; i < std::min(to, front.size()); ++i) {
    if (front[i] == kNone) continue;
    double throat = -kNone;
    for (std::size_t k = i + 1; k < std::min(i + 1 + Bins(36), front.size()); ++k) {
      if (front[k] != kNone) throat = std::min(throat, front[k]);
    }
    if (throat == -kNone || front[i] - throat <= found.chin_drop_mm) continue;
    found.chin_drop_mm = front[i] - throat;
    found.chin = i;
  }
  if (found.chin_drop_mm < kLeastChinDropMm) {
    found.chin_drop_mm = 0;
    return;
  }
  // The drop is the same from lip and chin where the light leaves a gap: the lowest bin that is as far in front.
  const double chin = front[found.chin];
  for (std::size_t k = found.chin + 1; k < std::min(found.chin + 1 + Bins(36), front.size()); ++k) {
    if (front[k] == kNone || front[k] < chin - 0.3 * found.chin_drop_mm) break;
    found.chin = k;
  }
}

/// Narrowest part between a head and shoulders much wider than it.
bool FindNeck(const std::vector<Run>& runs, Landmarks& found) {
  for (std::size_t i = Bins(kCrownToNeckMm); i < runs.size(); ++i) {
    std::size_t neck = i;
    for (std::size_t k = Bins(kCrownToNeckMm); k < i; ++k) {
      if (runs[k].Width() < runs[neck].Width()) neck = k;
    }
    double widest = 0;
    for (std::size_t k = 0; k < neck; ++k) widest = std::max(widest, runs[k].Width());
    if (neck < i && runs[i].Width() > kShoulderRatio * widest && runs[neck].Width() < 0.92 * widest) {
      found.neck = neck;
      found.shoulder = i;
      found.head_width = widest;
      return true;
    }
  }
  return false;
}

}  // namespace

Silhouette Scan(const Points& in_subject, float back) {
  Silhouette s;
  s.top = kNone;
  double bottom = -kNone;
  for (const auto& p : in_subject) {
    if (p.x() < back) continue;
    s.top = std::max<double>(s.top, p.y());
    bottom = std::min<double>(bottom, p.y());
  }
  if (s.top == kNone) return s;
  s.bins.resize(static_cast<std::size_t>((s.top - bottom) / kBinMm) + 1);
  for (const auto& p : in_subject) {
    if (p.x() >= back) s.bins[s.BinOf(p.y())].push_back({p.z(), p.x()});
  }
  for (auto& bin : s.bins) {
    std::sort(bin.begin(), bin.end(), [](const auto& a, const auto& b) {
      return a.right < b.right || (a.right == b.right && a.forward < b.forward);
    });
  }
  return s;
}

Outline Follow(const Silhouette& s) {
  Outline outline;
  std::optional<Run> last;
  for (std::size_t bin = 0; bin < s.bins.size(); ++bin) {
    const std::vector<Run> runs = RunsOf(s.bins[bin]);
    if (!last) {
      for (const Run& run : runs) {  // specks above the head are narrower than 20 mm
        if (run.Width() >= 20 && (!last || run.Width() > last->Width())) last = run;
      }
      if (!last) continue;
      outline.first = bin;
      outline.runs.push_back(*last);
      continue;
    }
    const auto next = Continue(runs, *last);
    outline.runs.push_back(next ? *next : Run{last->Middle(), last->Middle()});
    if (next) last = next;
  }
  return outline;
}

std::optional<Landmarks> FindLandmarks(const Silhouette& silhouette, const Outline& outline) {
  Landmarks found;
  const bool necked = FindNeck(outline.runs, found);
  // The midline: of the runs' middles over what is head for certain.
  const std::size_t head_end = std::min(necked ? found.neck : Bins(150), outline.runs.size());
  std::vector<double> middles;
  for (std::size_t i = head_end / 3; i < head_end; ++i) middles.push_back(outline.runs[i].Middle());
  if (middles.empty()) return std::nullopt;
  std::nth_element(middles.begin(), middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2), middles.end());
  found.middle = middles[middles.size() / 2];
  FindChin(Midline(silhouette, outline, found.middle), Bins(60),
           necked ? std::min(found.neck + Bins(30), found.shoulder) : Bins(330), found);
  if (necked) return found;
  if (found.chin_drop_mm <= 0) return std::nullopt;
  for (std::size_t i = 0; i < found.chin; ++i) found.head_width = std::max(found.head_width, outline.runs[i].Width());
  if (found.head_width > kWidestHairMm) return std::nullopt;
  found.head_width = std::min(found.head_width, kWidestHeadMm);
  for (std::size_t i = found.chin + Bins(24); i < outline.runs.size(); ++i) {
    if (outline.runs[i].Width() <= kShoulderRatio * found.head_width) continue;
    found.shoulder = i;
    found.neck = (found.chin + i) / 2;
    return found;
  }
  return std::nullopt;
}

}  // namespace striae::head::detail
