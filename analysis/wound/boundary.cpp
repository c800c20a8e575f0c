#include "analysis/wound/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "analysis/wound/detail/boundary_field.h"
#include "analysis/wound/detail/line.h"
#include "analysis/wound/detail/scene.h"
#include "core/surface_comments.h"

namespace striae::wound {
namespace {

constexpr double kLeastCells = 60;
constexpr const char* kNothing = "nothing there differs enough from the skin around it; draw the outline by hand";

// Mean and inverse spread of the two sides near the line, feature by feature: how like the wound a cell is, from -1
// (skin) to 1 (wound), along the line between their means.
struct Likeness {
  Eigen::Vector3d middle, axis;
  double spread = 1;  ///< sd of either side along the axis, as a share of half their distance
  [[nodiscard]] double Of(const Eigen::Vector3d& feature) const { return (feature - middle).dot(axis); }
};

Eigen::Vector3d FeatureAt(const BoundaryField& field, const Eigen::Vector2d& cell) {
  const double x = std::clamp(cell.x(), 0.0, field.patch.width - 1.001),
               y = std::clamp(cell.y(), 0.0, field.patch.height - 1.001);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double u = x - i, v = y - j;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      sum += (a != 0 ? u : 1 - u) * (b != 0 ? v : 1 - v) * field.smooth[field.patch.At(i + a, j + b)];
    }
  }
  return sum;
}

// From the features that `used` is 1 for.
std::optional<Likeness> LearnLikeness(const BoundaryField& field, const Eigen::Vector3d& used) {
  Eigen::Vector3d mean[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double count[2] = {0, 0};
  const auto side = [&](std::size_t c) { return field.classes[c] == CellClass::kWound ? 1 : 0; };
  for (std::size_t c = 0; c < field.classes.size(); ++c) {
    if (field.patch.state[c] != Patch::kMeasured) continue;
    mean[side(c)] += field.smooth[c].cwiseProduct(used);
    ++count[side(c)];
  }
  if (count[0] < kLeastCells || count[1] < kLeastCells) return std::nullopt;
  mean[0] /= count[0];
  mean[1] /= count[1];
  const Eigen::Vector3d apart = (mean[1] - mean[0]) / 2;
  if (apart.norm() < 1) return std::nullopt;
  Likeness likeness{(mean[0] + mean[1]) / 2, apart / apart.squaredNorm(), 1};
  double squares = 0;
  for (std::size_t c = 0; c < field.classes.size(); ++c) {
    if (field.patch.state[c] != Patch::kMeasured) continue;
    squares += std::pow(likeness.Of(field.smooth[c]) - (side(c) == 1 ? 1 : -1), 2);
  }
  likeness.spread = std::sqrt(squares / (count[0] + count[1]));
  return likeness;
}

// Colour has the sharper edge and is followed alone where it parts the two sides well; depth begins gently at many
// rims.
std::optional<Likeness> ClearColour(const BoundaryField& field) {
  constexpr double kClear = 0.6;
  auto colour = LearnLikeness(field, {1, 1, 0});
  return colour && colour->spread < kClear ? colour : std::nullopt;
}

// Parts the cells, and says by what their border is to be followed. The photograph's hues are as sharp as it is, and
// stand alone where they suffice: depths beside a rim are the surface's least sure ones.
Result<Likeness> CutAndLearn(BoundaryField& field, bool by_hue) {
  if (by_hue) {
    auto hues = field.features;
    for (auto& f : hues) f[2] = 0;
    auto parted = field.classes;
    if (CutOut(field.patch.width, field.patch.height, hues, parted)) {
      std::swap(field.classes, parted);
      if (auto colour = ClearColour(field)) return *colour;
      std::swap(field.classes, parted);
    }
  }
  if (auto cut = CutOut(field.patch.width, field.patch.height, field.features, field.classes); !cut) {
    return Fail(cut.error());
  }
  if (auto colour = ClearColour(field)) return *colour;
  if (auto both = LearnLikeness(field, {1, 1, 1})) return *both;
  return Fail(ErrorCode::kMeasurementRefused, kNothing);
}

// Moves each point along the line's normal to the crossing nearest to it; where none is within reach it stays.
Polygon Refine(const BoundaryField& field, const Likeness& likeness, const Polygon& line, double reach_cells) {
  Polygon moved = line;
  const std::size_t n = line.size();
  double twice = 0;
  for (std::size_t k = 0; k < n; ++k)
    twice += line[k].x() * line[(k + 1) % n].y() - line[k].y() * line[(k + 1) % n].x();
  constexpr double kStep = 0.25;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d along = (line[(k + 2) % n] - line[(k + n - 2) % n]).normalized();
    const Eigen::Vector2d outwards = (twice > 0 ? 1 : -1) * Eigen::Vector2d(along.y(), -along.x());
    double best = std::numeric_limits<double>::infinity();
    double before = likeness.Of(FeatureAt(field, line[k] - reach_cells * outwards));
    for (double t = -reach_cells + kStep; t <= reach_cells; t += kStep) {
      const double here = likeness.Of(FeatureAt(field, line[k] + t * outwards));
      if (before > 0 && here <= 0) {
        const double crossing = t - kStep * here / (here - before);
        if (std::abs(crossing) < std::abs(best)) best = crossing;
      }
      before = here;
    }
    if (std::isfinite(best)) moved[k] = line[k] + best * outwards;
  }
  return moved;
}

// Share of the line where the likeness falls by two sd or more within a few cells outwards.
double ContrastShare(const BoundaryField& field, const Likeness& likeness, const Polygon& line, double reach_cells) {
  double clear = 0;
  const PolygonField inside(line);
  const std::size_t n = line.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d along = (line[(k + 2) % n] - line[(k + n - 2) % n]).normalized();
    Eigen::Vector2d outwards(along.y(), -along.x());
    if (inside.At(line[k] + 0.5 * outwards).distance < 0) outwards = -outwards;
    const double drop = likeness.Of(FeatureAt(field, line[k] - reach_cells * outwards)) -
                        likeness.Of(FeatureAt(field, line[k] + reach_cells * outwards));
    if (drop > 2 * std::min(likeness.spread, 0.5)) ++clear;
  }
  return clear / static_cast<double>(n);
}

}  // namespace

Result<BoundaryProposal> ProposeBoundary(const Surface& surface, const BoundaryHints& hints,
                                         const BoundaryOptions& options, const ImageRgb* photograph) {
  if (photograph != nullptr &&
      (photograph->width() != surface.sensor_width_px || photograph->height() != surface.sensor_height_px)) {
    return Fail(ErrorCode::kUsage, "the photograph has another size than the one that the surface was made from");
  }
  if (auto same = CheckPhotograph(surface, hints.drawn); !same) return Fail(same.error());
  auto field = PrepareField(surface, hints, options, photograph);
  if (!field) return Fail(field.error());
  const Patch& patch = field->patch;
  const auto learnt = CutAndLearn(*field, photograph != nullptr);
  if (!learnt) return Fail(learnt.error());
  std::vector<std::uint8_t> inside(patch.size());
  for (std::size_t c = 0; c < patch.size(); ++c) inside[c] = field->classes[c] == CellClass::kWound ? 1 : 0;
  Polygon line;
  for (const auto& p : LongestBorder(patch.width, patch.height, inside)) line.emplace_back(p[0], p[1]);
  if (line.size() < 12) return Fail(ErrorCode::kMeasurementRefused, kNothing);
  const double sd_cells = options.smoothing_mm / patch.cell_mm(), reach = options.refine_mm / patch.cell_mm();
  line = Smoothed(Resample(line, 1), sd_cells);
  line = Smoothed(Resample(Refine(*field, *learnt, line, reach), 1.5), sd_cells);
  BoundaryProposal proposal;
  proposal.confidence = ContrastShare(*field, *learnt, line, 3);
  proposal.pixel_mm = patch.pixel_mm;
  proposal.area_mm2 = EnclosedArea(line) * patch.cell_mm() * patch.cell_mm();
  const Eigen::Vector2d first = patch.Pixel(0, 0);
  for (const auto& p : line) proposal.outline.polygon_px.push_back(first + p * patch.bin_px);
  if (SelfCrossing(proposal.outline.polygon_px)) {
    return Fail(ErrorCode::kMeasurementRefused, "the border found there is no simple line; draw the outline by hand");
  }
  proposal.outline.image_sha256 = PhotographOf(surface);
  return proposal;
}

BoundaryRepeatability RepeatBoundary(const Surface& surface, const BoundaryHints& hints,
                                     const BoundaryProposal& proposal, const BoundaryOptions& options,
                                     const ImageRgb* photograph) {
  constexpr int kTimes = 8;
  constexpr double kPointed_mm = 1.5, kDrawn_mm = 0.5;
  BoundaryRepeatability repeats;
  repeats.shaken_mm = hints.drawn.polygon_px.empty() ? kPointed_mm : kDrawn_mm;
  std::mt19937 random(1);
  std::normal_distribution<double> off(0, repeats.shaken_mm / proposal.pixel_mm);
  const auto shake = [&](std::vector<Eigen::Vector2d>& points) {
    for (auto& p : points) p += Eigen::Vector2d(off(random), off(random));
  };
  double sum = 0, squares = 0, distances = 0, points = 0;
  for (; repeats.tried < kTimes; ++repeats.tried) {
    BoundaryHints shaken = hints;
    shake(shaken.box);
    shake(shaken.drawn.polygon_px);
    for (auto& stroke : shaken.wound_strokes) shake(stroke);
    for (auto& stroke : shaken.skin_strokes) shake(stroke);
    const auto again = ProposeBoundary(surface, shaken, options, photograph);
    if (!again) continue;
    ++repeats.found;
    sum += again->area_mm2;
    squares += again->area_mm2 * again->area_mm2;
    const PolygonField line(again->outline.polygon_px);
    for (const auto& p : proposal.outline.polygon_px) {
      distances += std::pow(line.At(p).distance * proposal.pixel_mm, 2);
      ++points;
    }
  }
  if (repeats.found > 1) {
    const double mean = sum / repeats.found;
    repeats.area_cv = std::sqrt(std::max(0.0, squares - sum * mean) / (repeats.found - 1)) / mean;
  }
  repeats.line_sd_mm = points > 0 ? std::sqrt(distances / points) : 0;
  return repeats;
}

}  // namespace striae::wound
