#include "analysis/wound/detail/boundary_field.h"

#include <algorithm>
#include <cmath>

#include "analysis/wound/detail/cell_colours.h"
#include "analysis/wound/detail/polygon.h"
#include "analysis/wound/detail/skin.h"

namespace striae::wound {
namespace {

constexpr double kShallowest_mm = -1.5, kDeepest_mm = 2.5;  // what deeper means than this does not matter to the cut
constexpr double kColourGain = 3;                           // skin and wound differ by 5 to 40 of a*'s 256 steps
constexpr double kDeep_mm = 0.5, kWall_mm = 5;              // missing cells so near to cells so deep are a wall
constexpr double kCore = 0.35;                              // of the box's half sides: surely wound

Eigen::Vector2d ToCell(const Patch& patch, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d first = patch.Pixel(0, 0);
  return (pixel - first) / patch.bin_px;
}

std::vector<Eigen::Vector2d> HintPoints(const BoundaryHints& hints) {
  std::vector<Eigen::Vector2d> all = hints.box;
  all.insert(all.end(), hints.drawn.polygon_px.begin(), hints.drawn.polygon_px.end());
  for (const auto& stroke : hints.wound_strokes) all.insert(all.end(), stroke.begin(), stroke.end());
  return all;
}

// Depth of every cell that is not missing below a quadric through the cells outside the box.
std::vector<double> DepthsBelowSkin(const Patch& patch, const std::vector<CellClass>& classes) {
  std::vector<double> depth(patch.size(), 0);
  std::vector<Eigen::Vector3d> skin_points;
  for (std::size_t c = 0; c < patch.size(); c += 3) {
    if (patch.state[c] == Patch::kMeasured && classes[c] == CellClass::kSkin) skin_points.push_back(patch.point[c]);
  }
  if (skin_points.size() < 100) return depth;
  const Frame frame = FitFrame(skin_points);
  for (auto& p : skin_points) p = frame.FromCamera(p);
  const Skin skin = FitSkin(SkinModel::kQuadric, skin_points, WeighRing(skin_points));
  for (std::size_t c = 0; c < patch.size(); ++c) {
    if (patch.state[c] == Patch::kMissing) continue;
    const Eigen::Vector3d p = frame.FromCamera(patch.point[c]);
    depth[c] = skin.Height(p.x(), p.y()) - p.z();
  }
  return depth;
}

void MarkStroke(const std::vector<Eigen::Vector2d>& stroke, CellClass mark, BoundaryField& field) {
  for (std::size_t k = 0; k < stroke.size(); ++k) {
    const Eigen::Vector2d a = ToCell(field.patch, stroke[k]), b = ToCell(field.patch, stroke[k > 0 ? k - 1 : 0]);
    const int steps = 1 + static_cast<int>(2 * (b - a).norm());
    for (int s = 0; s <= steps; ++s) {
      const Eigen::Vector2d p = a + (b - a) * s / steps;
      const int i = static_cast<int>(std::lround(p.x())), j = static_cast<int>(std::lround(p.y()));
      if (i < 0 || j < 0 || i >= field.patch.width || j >= field.patch.height) continue;
      field.classes[field.patch.At(i, j)] = mark;
    }
  }
}

void MarkBox(const Eigen::Vector2d& low, const Eigen::Vector2d& high, bool core, BoundaryField& field) {
  const Eigen::Vector2d middle = (low + high) / 2, half = (high - low) / 2;
  for (int j = 0; j < field.patch.height; ++j) {
    for (int i = 0; i < field.patch.width; ++i) {
      const Eigen::Vector2d off = (field.patch.Pixel(i, j) - middle).cwiseAbs().cwiseQuotient(half);
      auto& mark = field.classes[field.patch.At(i, j)];
      mark = off.maxCoeff() > 1 ? CellClass::kSkin : CellClass::kProbablyWound;
      if (core && off.norm() < kCore) mark = CellClass::kWound;
    }
  }
}

// Beyond 2 mm from a drawn line the sides are known; of a small wound at least the middle is.
void MarkDrawn(const Polygon& drawn, BoundaryField& field) {
  constexpr double kCertain_mm = 2, kMiddle = 0.6;
  const PolygonField line(drawn);
  std::vector<double> distance_mm(field.patch.size());
  double inmost_mm = 0;
  for (int j = 0; j < field.patch.height; ++j) {
    for (int i = 0; i < field.patch.width; ++i) {
      double& d = distance_mm[field.patch.At(i, j)];
      d = line.At(field.patch.Pixel(i, j)).distance * field.patch.pixel_mm;
      inmost_mm = std::max(inmost_mm, -d);
    }
  }
  const double core_mm = std::min(kCertain_mm, kMiddle * inmost_mm);
  for (std::size_t c = 0; c < distance_mm.size(); ++c) {
    const double d = distance_mm[c];
    field.classes[c] = d > kCertain_mm ? CellClass::kSkin
                       : d > 0         ? CellClass::kProbablySkin
                       : d < -core_mm  ? CellClass::kWound
                                       : CellClass::kProbablyWound;
  }
}

std::uint8_t Scaled(double value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))); }

// What is known of the cells: with a photograph the hues of all, and depths that a membrane continues into holes; else
// the surface's colours, and holes beside the wound as its walls.
struct Known {
  CellColours colours;
  std::vector<double> depth_mm;
  std::vector<std::uint8_t> is_known;
};

Known WhatIsKnown(const Surface& surface, const ImageRgb* photograph, const BoundaryField& field) {
  const Patch& patch = field.patch;
  if (photograph != nullptr) {
    Patch whole = patch;
    FillHoles(whole, std::vector<std::uint8_t>(patch.size(), 1));
    return {HuesOf(*photograph, patch), DepthsBelowSkin(whole, field.classes),
            std::vector<std::uint8_t>(patch.size(), 1)};
  }
  Known known{ColoursOf(surface, patch), DepthsBelowSkin(patch, field.classes), {}};
  for (const auto state : patch.state) known.is_known.push_back(state == Patch::kMeasured ? 1 : 0);
  const auto reach_cells = static_cast<int>(std::lround(kWall_mm / patch.cell_mm()));
  for (const auto c : GiveToWound(patch, kDeep_mm, reach_cells, known.depth_mm, known.colours)) known.is_known[c] = 1;
  return known;
}

void FillFeatures(const Surface& surface, const ImageRgb* photograph, BoundaryField& field) {
  const auto [colours, depth, known] = WhatIsKnown(surface, photograph, field);
  const auto lab = ToLab(colours);
  double mean_a = 0, mean_b = 0, count = 0;
  for (std::size_t c = 0; c < lab.size(); ++c) {
    if (field.classes[c] != CellClass::kSkin || known[c] == 0) continue;
    mean_a += lab[c][1];
    mean_b += lab[c][2];
    ++count;
  }
  if (count > 0) {
    mean_a /= count;
    mean_b /= count;
  }
  field.features.resize(lab.size());
  for (std::size_t c = 0; c < lab.size(); ++c) {
    const double share =
        (std::clamp(depth[c], kShallowest_mm, kDeepest_mm) - kShallowest_mm) / (kDeepest_mm - kShallowest_mm);
    field.features[c] = {known[c] != 0 ? Scaled(96 + kColourGain * (lab[c][1] - mean_a)) : std::uint8_t{96},
                         known[c] != 0 ? Scaled(96 + kColourGain * (lab[c][2] - mean_b)) : std::uint8_t{96},
                         Scaled(255 * share)};
    if (known[c] == 0 && field.classes[c] == CellClass::kProbablyWound) field.classes[c] = CellClass::kProbablySkin;
  }
}

void SmoothFeatures(BoundaryField& field) {
  const Patch& patch = field.patch;
  field.smooth.assign(patch.size(), Eigen::Vector3d::Zero());
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      double count = 0;
      auto& sum = field.smooth[patch.At(i, j)];
      for (int b = std::max(0, j - 1); b <= std::min(patch.height - 1, j + 1); ++b) {
        for (int a = std::max(0, i - 1); a <= std::min(patch.width - 1, i + 1); ++a) {
          const auto& f = field.features[patch.At(a, b)];
          sum += Eigen::Vector3d(f[0], f[1], f[2]);
          ++count;
        }
      }
      sum /= count;
    }
  }
}

}  // namespace

Result<BoundaryField> PrepareField(const Surface& surface, const BoundaryHints& hints, const BoundaryOptions& options,
                                   const ImageRgb* photograph) {
  const auto points = HintPoints(hints);
  if (points.size() < 2)
    return Fail(ErrorCode::kUsage, "give a box around the wound, a stroke in it, or a drawn outline");
  Eigen::Vector2d low = points.front(), high = low;
  for (const auto& p : points) {
    if (!p.allFinite()) return Fail(ErrorCode::kUsage, "a box or stroke has a point that is not finite");
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!((high - low).minCoeff() > 4)) return Fail(ErrorCode::kUsage, "the box around the wound is empty");
  const bool boxed = !hints.box.empty(), drawn = hints.drawn.polygon_px.size() >= 3;
  if (!boxed && !drawn) {  // strokes lie well inside: the wound may be as large again on every side
    const Eigen::Vector2d grow = (high - low).cwiseMax(0.5 * (high - low).maxCoeff());
    low -= grow;
    high += grow;
  }
  if (!surface.HasGrid() || surface.colour.size() != surface.size()) {
    return Fail(ErrorCode::kBadFile,
                "the surface has no sensor pixels or colours; use one that striae reconstruct wrote");
  }
  Polygon corners = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (auto& p : corners) {
    p.x() = std::clamp(p.x(), 0.0, surface.sensor_width_px - 1.0);
    p.y() = std::clamp(p.y(), 0.0, surface.sensor_height_px - 1.0);
  }
  BoundaryField field;
  // The patch knows the pixel's size first; the margin is a share of the box in pixels, so in mm by a rough cut.
  auto rough = CutPatch(surface, corners, options.cell_mm, 1);
  if (!rough) return Fail(rough.error());
  const double margin_mm = options.margin_share * (high - low).maxCoeff() * rough->pixel_mm;
  auto patch = CutPatch(surface, corners, options.cell_mm, margin_mm);
  if (!patch) return Fail(patch.error());
  field.patch = *std::move(patch);
  field.classes.assign(field.patch.size(), CellClass::kSkin);
  if (drawn) {
    MarkDrawn(hints.drawn.polygon_px, field);
  } else {
    MarkBox(low, high, boxed && hints.wound_strokes.empty(), field);
  }
  FillFeatures(surface, photograph, field);
  SmoothFeatures(field);
  for (const auto& stroke : hints.wound_strokes) MarkStroke(stroke, CellClass::kWound, field);
  for (const auto& stroke : hints.skin_strokes) MarkStroke(stroke, CellClass::kSkin, field);
  return field;
}

}  // namespace striae::wound
