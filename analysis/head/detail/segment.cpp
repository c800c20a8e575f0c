#include "analysis/head/detail/segment.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace striae::head::detail {
namespace {

constexpr double kBinMm = 6;            // two to three points high: a silhouette without holes
constexpr double kGapMm = 25;           // eyes, nostrils and stripes lost to shadow do not split a silhouette
constexpr double kBodyDepthMm = 450;    // the large grating's measuring depth and a little: what lies behind is a wall
constexpr double kShoulderRatio = 1.6;  // shoulder breadth over head breadth is 2.4-3 in adults, 1.8 in small children

/// One unbroken run of the silhouette in a bin: from..to along the subject's right.
struct Run {
  double from = 0, to = 0;
  std::size_t points = 0;
  [[nodiscard]] double Width() const { return to - from; }
  [[nodiscard]] double Middle() const { return (from + to) / 2; }
};

/// Bins from the top down; each has the right-coordinates of its points.
struct Silhouette {
  double top = 0;
  std::vector<std::vector<double>> bins;
  [[nodiscard]] double HeightOf(std::size_t bin) const { return top - (static_cast<double>(bin) + 0.5) * kBinMm; }
};

Silhouette Scan(const Points& in_subject, float back) {
  Silhouette s;
  std::vector<float> heights;
  for (const auto& p : in_subject) {
    if (p.x() >= back) heights.push_back(p.y());
  }
  if (heights.empty()) return s;
  s.top = *std::max_element(heights.begin(), heights.end());
  const double bottom = *std::min_element(heights.begin(), heights.end());
  s.bins.resize(static_cast<std::size_t>((s.top - bottom) / kBinMm) + 1);
  for (const auto& p : in_subject) {
    if (p.x() >= back) s.bins[static_cast<std::size_t>((s.top - p.y()) / kBinMm)].push_back(p.z());
  }
  for (auto& bin : s.bins) std::sort(bin.begin(), bin.end());
  return s;
}

std::vector<Run> RunsOf(const std::vector<double>& bin) {
  std::vector<Run> runs;
  for (const double z : bin) {
    if (runs.empty() || z - runs.back().to > kGapMm) runs.push_back({z, z, 0});
    runs.back().to = z;
    ++runs.back().points;
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

struct Profile {
  std::size_t first = 0;               ///< bin of the head's top
  std::vector<Run> runs;               ///< from `first` down; width 0 where the neck is lost in the chin's shadow
  std::size_t neck = 0, shoulder = 0;  ///< indices into runs
  double head_width = 0;
};

/// Follows the silhouette from the top until it has widened to the shoulders.
std::optional<Profile> Follow(const Silhouette& s) {
  Profile profile;
  std::optional<Run> last;
  for (std::size_t bin = 0; bin < s.bins.size(); ++bin) {
    const std::vector<Run> runs = RunsOf(s.bins[bin]);
    if (!last) {
      // Specks above the head are narrower than 20 mm.
      for (const Run& run : runs) {
        if (run.Width() >= 20 && (!last || run.Width() > last->Width())) last = run;
      }
      if (!last) continue;
      profile.first = bin;
      profile.runs.push_back(*last);
      continue;
    }
    const auto next = Continue(runs, *last);
    profile.runs.push_back(next ? *next : Run{last->Middle(), last->Middle(), 0});
    if (next) last = next;
  }
  if (profile.runs.empty()) return std::nullopt;
  // Shoulders: the first place, at least 120 mm below the top, that is much wider than the narrowest part above it
  // and than the head. The head's width is the largest one above that narrowest part.
  const auto least_bins = static_cast<std::size_t>(120 / kBinMm);
  for (std::size_t i = least_bins; i < profile.runs.size(); ++i) {
    std::size_t neck = i;
    for (std::size_t k = least_bins; k < i; ++k) {
      if (profile.runs[k].Width() < profile.runs[neck].Width()) neck = k;
    }
    double widest = 0;
    for (std::size_t k = 0; k < neck; ++k) widest = std::max(widest, profile.runs[k].Width());
    if (neck < i && profile.runs[i].Width() > kShoulderRatio * widest && profile.runs[neck].Width() < 0.92 * widest) {
      profile.neck = neck;
      profile.shoulder = i;
      profile.head_width = widest;
      return profile;
    }
  }
  return std::nullopt;
}

/// Depth (subject's forward axis) that 95 % of the points stay behind.
float Front(const Points& in_subject) {
  std::vector<float> x;
  x.reserve(in_subject.size());
  for (const auto& p : in_subject) x.push_back(p.x());
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(x.size() * 95 / 100);
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

}  // namespace

Result<Segmentation> Segment(const Cloud& cloud, const Eigen::Matrix3d& subject_from_camera) {
  const auto no = [](const std::string& what) {
    return Fail(ErrorCode::kMeasurementRefused,
                what + "; the neutral capture must show head, bare neck and shoulders of one person facing the camera");
  };
  if (cloud.size() < 2000) return no("too few points for a head and a torso (" + std::to_string(cloud.size()) + ")");
  Points in_subject;
  in_subject.reserve(cloud.size());
  for (const auto& p : cloud.point) in_subject.push_back(subject_from_camera.cast<float>() * p);

  const float back = Front(in_subject) - static_cast<float>(kBodyDepthMm);
  const Silhouette silhouette = Scan(in_subject, back);
  const auto profile = Follow(silhouette);
  if (!profile) return no("no head over shoulders found: the outline never narrows to a neck and widens again");

  Segmentation found;
  const auto height = [&](std::size_t run) { return silhouette.HeightOf(profile->first + run); };
  found.top_mm = height(0) + kBinMm / 2;
  found.neck_mm = height(profile->neck);
  found.shoulder_mm = height(profile->shoulder);
  found.head_width_mm = profile->head_width;
  const double head_height = found.top_mm - found.neck_mm;
  if (profile->head_width < 90 || profile->head_width > 300 || head_height < 130 || head_height > 380) {
    return no("what should be the head is " + std::to_string(std::lround(profile->head_width)) + " mm wide and " +
              std::to_string(std::lround(head_height)) + " mm high");
  }

  // Upper face: below the hair's top, above mouth and jaw, without ears. Torso: the breastbone's surroundings, below
  // the collar bones, without shoulders. Surfaces seen at more than 70 degrees of grazing are left out.
  const double face_top = found.top_mm - 0.14 * head_height, face_bottom = found.top_mm - 0.68 * head_height;
  const double chest_top = found.shoulder_mm - 15, chest_bottom = chest_top - 260;
  const double chest_middle = profile->runs[profile->neck].Middle();
  double neck_front = 0;
  std::size_t neck_points = 0;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = in_subject[i];
    if (p.x() < back) continue;
    if (p.y() <= found.neck_mm + 60 && p.y() >= found.neck_mm - 60 && std::abs(p.z() - chest_middle) < 30) {
      neck_front += p.x();
      ++neck_points;
    }
    if (-cloud.normal[i].dot(cloud.point[i].normalized()) < 0.34F) continue;
    if (p.y() <= face_top && p.y() >= face_bottom) {
      const auto bin = static_cast<std::size_t>((silhouette.top - p.y()) / kBinMm) - profile->first;
      const Run& run = profile->runs[bin];
      if (std::abs(p.z() - run.Middle()) <= 0.45 * std::min(run.Width(), profile->head_width)) found.head.push_back(i);
    } else if (p.y() <= chest_top && p.y() >= chest_bottom &&
               std::abs(p.z() - chest_middle) <= 0.9 * profile->head_width) {
      found.torso.push_back(i);
    }
  }
  if (found.head.size() < 300) return no("too little of the face is measured");
  if (found.torso.size() < 1000) return no("too little of the chest is measured");
  if (neck_points == 0) return no("no skin is measured about the neck");
  // Half a neck's depth behind its skin.
  const Eigen::Vector3d neck(neck_front / static_cast<double>(neck_points) - 55, found.neck_mm, chest_middle);
  found.neck_in_camera = subject_from_camera.transpose() * neck;
  return found;
}

}  // namespace striae::head::detail
