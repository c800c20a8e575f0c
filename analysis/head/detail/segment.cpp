#include "analysis/head/detail/segment.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "analysis/head/detail/silhouette.h"
#include "core/outline.h"

namespace striae::head::detail {
namespace {

constexpr double kBodyDepthMm = 450;  // the large grating's measuring depth and a little: what lies behind is a wall
constexpr double kMouthAboveChinMm = 42;  // of adults, the upper lip's edge (stomion 35-45 mm over the chin's point)
constexpr double kRimMm = 8;              // the light's edge or the outline's: the Fourier window frays
constexpr float kLeastFacing = 0.34F;     // cosine: skin seen at more than 70 degrees of grazing is left out
constexpr double kLeastNoseMm = 9;        // a sphere of a head's size: 6 mm
constexpr std::size_t kFewFace =
    800;  // upper faces have 1500 to 3500 at 2 mm; below, the jaw's skin is worth its movement
constexpr double kJawAboveChinMm = 12;
constexpr double kTorsoHeightMm = 260;
constexpr double kWidestHeadMm = 180;  // what is wider is hair
constexpr float kLargestSdMm = 1.0F;   // hair, rims

tl::unexpected<Error> No(const std::string& what) {
  return Fail(ErrorCode::kMeasurementRefused,
              what + "; the neutral capture must show head, bare neck and shoulders of one person facing the camera");
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

/// How far the front within 12 mm of `middle` stands out from the front 26 to 34 mm beside it, on the side that reaches
/// further, over three bins; 0 where one of them is not measured.
double RidgeAt(const Silhouette& s, std::size_t bin, double middle) {
  constexpr double kNothing = -1e9;
  double centre = kNothing, beside[2] = {kNothing, kNothing};
  for (std::size_t k = bin; k < bin + 3; ++k) {
    for (const auto& p : s.bins[k]) {
      const double off = p.right - middle;
      if (std::abs(off) <= 12) centre = std::max<double>(centre, p.forward);
      if (std::abs(off) < 26 || std::abs(off) > 34) continue;
      double& side = beside[off < 0 ? 0 : 1];
      side = std::max<double>(side, p.forward);
    }
  }
  const double least = std::min({centre, beside[0], beside[1]});
  return least == kNothing ? 0 : centre - std::max(beside[0], beside[1]);
}

/// How far the nose stands out: the most of RidgeAt between the head's ends, up to 40 mm from its middle line (a head
/// that is turned by 20 degrees carries its nose 35 mm to the side).
double NoseOf(const Silhouette& s, std::size_t from, std::size_t to, double middle) {
  double most = 0;
  for (std::size_t bin = from; bin + 3 <= std::min(to, s.bins.size()); ++bin) {
    for (double off = -40; off <= 40; off += 8) most = std::max(most, RidgeAt(s, bin, middle + off));
  }
  return most;
}

/// Skin that is measured well enough to be registered.
bool Usable(const Cloud& cloud, std::uint32_t i) {
  return -cloud.normal[i].dot(cloud.point[i].normalized()) >= kLeastFacing && cloud.sd_mm[i] <= kLargestSdMm;
}

std::vector<std::uint32_t> InsideOf(const Cloud& cloud, const std::vector<Eigen::Vector2d>& polygon) {
  std::vector<std::uint32_t> inside;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (Usable(cloud, i) && Inside(polygon, cloud.pixel[i].cast<double>())) inside.push_back(i);
  }
  return inside;
}

Eigen::Vector3d Middle(const Cloud& cloud, const std::vector<std::uint32_t>& indices) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : indices) middle += cloud.point[i].cast<double>();
  return middle / static_cast<double>(std::max<std::size_t>(1, indices.size()));
}

Status CheckSizes(const Segmentation& found) {
  if (found.head.size() < 300) return No("too little of the face is measured");
  if (found.torso.size() < 1000) return No("too little of the chest is measured");
  return {};
}

/// Both parts drawn: the neck is taken a third of the way from the head's middle to the torso's, 55 mm deeper.
Result<Segmentation> FromDrawn(const Cloud& cloud, const Eigen::Matrix3d& subject_from_camera, const Regions& drawn) {
  Segmentation found;
  found.head = InsideOf(cloud, drawn.head_px);
  found.torso = InsideOf(cloud, drawn.torso_px);
  if (auto checked = CheckSizes(found); !checked) return Fail(checked.error());
  const Eigen::Vector3d back = subject_from_camera.transpose() * Eigen::Vector3d(-55, 0, 0);
  const Eigen::Vector3d head = Middle(cloud, found.head);
  found.neck_in_camera = head + (Middle(cloud, found.torso) - head) / 3 + back;
  return found;
}

/// Head and torso by the landmarks' heights.
void Collect(const Cloud& cloud, const Points& in_subject, const Silhouette& silhouette, const Outline& outline,
             const Landmarks& marks, float back, Segmentation& found) {
  found.head.clear();
  found.torso.clear();
  const double face_top = found.top_mm - kRimMm;
  const double face_bottom = found.chin_mm + (found.with_jaw ? kJawAboveChinMm : kMouthAboveChinMm);
  const double chest_top = found.shoulder_mm - 15, chest_bottom = chest_top - kTorsoHeightMm;
  const double chest_middle = outline.runs[marks.neck].Middle();
  const double head_width = std::min(marks.head_width, kWidestHeadMm);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = in_subject[i];
    if (p.x() < back || !Usable(cloud, i)) continue;
    if (p.y() <= face_top && p.y() >= face_bottom) {
      const Run& run = outline.runs[silhouette.BinOf(p.y()) - outline.first];
      const double half = std::min(0.45 * head_width, run.Width() / 2 - kRimMm / 2);
      if (std::abs(p.z() - run.Middle()) <= half) found.head.push_back(i);
    } else if (p.y() <= chest_top && p.y() >= chest_bottom && std::abs(p.z() - chest_middle) <= 0.9 * head_width) {
      found.torso.push_back(i);
    }
  }
}

/// Half a neck's depth behind its skin; none where no skin is measured about the neck.
std::optional<Eigen::Vector3d> Neck(const Points& in_subject, double neck_mm, double middle) {
  double front = 0;
  std::size_t points = 0;
  for (const auto& p : in_subject) {
    if (std::abs(p.y() - neck_mm) > 60 || std::abs(p.z() - middle) >= 30) continue;
    front += p.x();
    ++points;
  }
  if (points == 0) return std::nullopt;
  return Eigen::Vector3d(front / static_cast<double>(points) - 55, neck_mm, middle);
}

}  // namespace

Result<Segmentation> Segment(const Cloud& cloud, const Eigen::Matrix3d& subject_from_camera, const Regions& drawn) {
  if (cloud.size() < 2000) return No("too few points for a head and a torso (" + std::to_string(cloud.size()) + ")");
  const bool head_drawn = !drawn.head_px.empty(), torso_drawn = !drawn.torso_px.empty();
  if ((head_drawn || torso_drawn) && !cloud.pixel.front().allFinite()) {
    return Fail(ErrorCode::kUsage,
                "regions were drawn on the photograph, but the neutral surface has no sensor pixels");
  }
  if (head_drawn && torso_drawn) return FromDrawn(cloud, subject_from_camera, drawn);
  Points in_subject;
  in_subject.reserve(cloud.size());
  for (const auto& p : cloud.point) in_subject.push_back(subject_from_camera.cast<float>() * p);

  const float back = Front(in_subject) - static_cast<float>(kBodyDepthMm);
  const Silhouette silhouette = Scan(in_subject, back);
  const Outline outline = Follow(silhouette);
  const auto marks = FindLandmarks(silhouette, outline);
  if (!marks) {
    return No("no head over shoulders found: the outline never narrows to a neck and widens again, and no chin shows");
  }
  Segmentation found;
  const auto height = [&](std::size_t run) { return silhouette.HeightOf(outline.first + run); };
  found.top_mm = height(0) + kBinMm / 2;
  found.neck_mm = height(marks->neck);
  found.shoulder_mm = height(marks->shoulder);
  found.head_width_mm = marks->head_width;
  // Without a chin (a beard, a shadow): the mouth at two thirds of the way from the top to the neck.
  const double to_neck = found.top_mm - found.neck_mm;
  found.chin_mm = marks->chin_drop_mm > 0 ? height(marks->chin) : found.top_mm - 0.68 * to_neck - kMouthAboveChinMm;
  if (marks->head_width < 90 || marks->head_width > 300 || to_neck < 100 || to_neck > 380) {
    return No("what should be the head is " + std::to_string(std::lround(marks->head_width)) + " mm wide and " +
              std::to_string(std::lround(to_neck)) + " mm high");
  }
  found.nose_mm = NoseOf(silhouette, outline.first, silhouette.BinOf(found.chin_mm + kMouthAboveChinMm), marks->middle);
  Collect(cloud, in_subject, silhouette, outline, *marks, back, found);
  if (!head_drawn && found.head.size() < kFewFace && marks->chin_drop_mm > 0) {
    found.with_jaw = true;
    Collect(cloud, in_subject, silhouette, outline, *marks, back, found);
  }
  if (head_drawn) found.head = InsideOf(cloud, drawn.head_px);
  if (torso_drawn) found.torso = InsideOf(cloud, drawn.torso_px);
  if (auto checked = CheckSizes(found); !checked) return Fail(checked.error());
  if (!head_drawn && found.nose_mm < kLeastNoseMm) {
    return No("no nose stands out of what should be the face (" + std::to_string(std::lround(found.nose_mm)) +
              " mm, at least " + std::to_string(std::lround(kLeastNoseMm)) + ")");
  }
  const auto neck = Neck(in_subject, found.neck_mm, outline.runs[marks->neck].Middle());
  if (!neck) return No("no skin is measured about the neck");
  found.neck_in_camera = subject_from_camera.transpose() * *neck;
  return found;
}

std::vector<Eigen::Vector2d> HullOf(const Cloud& cloud, const std::vector<std::uint32_t>& indices) {
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t i : indices) {
    if (cloud.pixel[i].allFinite()) points.push_back(cloud.pixel[i].cast<double>().array().round());
  }
  const auto before = [](const auto& a, const auto& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return {};
  // Andrew's monotone chain.
  std::vector<Eigen::Vector2d> hull;
  const auto chain = [&](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto p = begin; p != end; ++p) {
      const auto turns_in = [&] {
        const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2], b = *p - hull[hull.size() - 2];
        return a.x() * b.y() - a.y() * b.x() <= 0;
      };
      while (hull.size() >= start + 2 && turns_in()) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace striae::head::detail
