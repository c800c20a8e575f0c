#include "analysis/wound/detail/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/surface_comments.h"

namespace striae::wound {
namespace {

constexpr double kLeastBoundaryShare = 0.85;
constexpr double kMostHoles = 0.7, kMostBeyondBridge = 0.02;  // of the cells inside the outline
constexpr int kLeastCells = 30;

std::string Percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

Status CheckInputs(const Surface& surface, const Outline& outline) {
  if (!surface.HasGrid()) {
    return Fail(ErrorCode::kBadFile,
                "the surface has no sensor pixels (col, row of each vertex), so an outline cannot be laid on it; use a "
                "surface that striae reconstruct wrote");
  }
  if (auto same = CheckPhotograph(surface, outline); !same) return same;
  if (outline.polygon_px.size() < 3) return Fail(ErrorCode::kBadFile, "an outline needs at least three points");
  for (const auto& p : outline.polygon_px) {
    if (!p.allFinite()) return Fail(ErrorCode::kBadFile, "the outline has a point that is not finite");
    if (p.x() < 0 || p.y() < 0 || p.x() > surface.sensor_width_px - 1 || p.y() > surface.sensor_height_px - 1) {
      return Fail(ErrorCode::kOutlineOffSurface,
                  "the outline leaves the sensor of " + std::to_string(surface.sensor_width_px) + " x " +
                      std::to_string(surface.sensor_height_px) +
                      " pixels; draw it on the photograph that this surface was made from, in sensor pixels");
    }
  }
  if (SelfCrossing(outline.polygon_px)) {
    return Fail(ErrorCode::kBadFile, "the outline crosses itself; draw the wound as one simple line");
  }
  return {};
}

// Sensor distances of all cells to the outline, in mm by the mean pixel size: good enough to sort cells beforehand.
std::vector<double> SensorDistances(const Patch& patch, const Polygon& outline_px) {
  const PolygonField field(outline_px);
  std::vector<double> distance(patch.size());
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      distance[patch.At(i, j)] = field.At(patch.Pixel(i, j)).distance * patch.pixel_mm;
    }
  }
  return distance;
}

// Where the rays of the outline's points meet the skin (Newton along the ray; from the plane for a start).
Polygon LayOnSkin(const Polygon& outline_px, const Scene& scene, const Skin* skin) {
  Polygon polygon;
  const Eigen::Vector3d eye = scene.frame.FromCamera(Eigen::Vector3d::Zero());
  for (const auto& pixel : outline_px) {
    const Eigen::Vector3d ray = scene.frame.wound_from_camera * scene.patch.rays.Direction(pixel);
    double t = -eye.z() / ray.z();
    for (int k = 0; k < 20 && skin != nullptr; ++k) {
      const Eigen::Vector3d p = eye + t * ray;
      const double miss = p.z() - skin->Height(p.x(), p.y());
      const double rate = ray.z() - skin->Gradient(p.x(), p.y()).dot(ray.head<2>());
      if (std::abs(miss) < 1e-6 * skin->radius_mm || std::abs(rate) < 0.05) break;
      t -= miss / rate;
    }
    polygon.push_back((eye + t * ray).head<2>());
  }
  return polygon;
}

void Place(Scene& scene, const std::vector<std::uint8_t>& usable) {
  const PolygonField field(scene.outline);
  scene.local.assign(scene.patch.size(), Eigen::Vector3d::Zero());
  scene.place.assign(scene.patch.size(), {std::numeric_limits<double>::infinity(), 0});
  for (std::size_t cell = 0; cell < scene.patch.size(); ++cell) {
    if (usable[cell] == 0) continue;
    scene.local[cell] = scene.frame.FromCamera(scene.patch.point[cell]);
    scene.place[cell] = field.At(scene.local[cell].head<2>());
  }
}

// Splits the cells into inside, boundary and sheet, fills holes; what may be used is returned.
Result<std::vector<std::uint8_t>> SortCells(ScenePlus& plus, const std::vector<double>& distance,
                                            const Options& options) {
  Patch& patch = plus.scene.patch;
  const double band_mm = std::max(2 * patch.cell_mm(), 1.5 * options.perimeter_step_mm);
  const double fill_mm = options.margin_mm + 2 * patch.cell_mm();
  std::vector<std::uint8_t> outside(patch.size()), seeds(patch.size()), wanted(patch.size()), usable(patch.size());
  double inside = 0, holes = 0, band = 0, met = 0;
  for (std::size_t c = 0; c < patch.size(); ++c) {
    outside[c] = distance[c] > 0 ? 1 : 0;
    seeds[c] = distance[c] > 0 && distance[c] < band_mm ? 1 : 0;
    wanted[c] = distance[c] < fill_mm ? 1 : 0;
    inside += 1 - outside[c];
    holes += distance[c] <= 0 && patch.state[c] == Patch::kMissing ? 1 : 0;
  }
  if (inside < kLeastCells) {
    return Fail(ErrorCode::kMeasurementRefused, "the outline encloses only " + std::to_string(std::lround(inside)) +
                                                    " surface cells of " + std::to_string(patch.cell_mm()) +
                                                    " mm; a wound this small cannot be measured from this distance");
  }
  plus.hole_share = holes / inside;
  plus.scene.sheet = ConnectedSheet(patch, seeds, outside);
  for (std::size_t c = 0; c < patch.size(); ++c) {
    band += seeds[c];
    met += seeds[c] != 0 && plus.scene.sheet[c] != 0 ? 1 : 0;
  }
  plus.boundary_share = band > 0 ? met / band : 0;
  if (plus.boundary_share < kLeastBoundaryShare) {
    return Fail(ErrorCode::kOutlineOffSurface,
                "only " + Percent(plus.boundary_share) +
                    " of the outline runs along connected skin: it leaves the reconstructed surface or crosses the "
                    "body's edge; check that it was drawn on this photograph, or photograph the wound more squarely");
  }
  std::vector<std::uint8_t> interior(patch.size());
  for (std::size_t c = 0; c < patch.size(); ++c) interior[c] = outside[c] == 0 ? 1 : 0;
  if (plus.hole_share > kMostHoles || ShareBeyond(patch, interior, options.bridge_mm) > kMostBeyondBridge) {
    return Fail(ErrorCode::kMeasurementRefused,
                Percent(plus.hole_share) +
                    " of the surface inside the outline is missing (shadow, glare or a dark bed)"
                    "; photograph again with the wound facing the camera");
  }
  FillHoles(patch, wanted);
  for (std::size_t c = 0; c < patch.size(); ++c) {
    const bool near = wanted[c] != 0 && patch.state[c] == Patch::kFilled;
    usable[c] = patch.state[c] != Patch::kMissing && (outside[c] == 0 || plus.scene.sheet[c] != 0 || near) ? 1 : 0;
  }
  return usable;
}

}  // namespace

Status CheckPhotograph(const Surface& surface, const Outline& outline) {
  const auto photograph = PhotographOf(surface);
  if (!photograph || !outline.image_sha256 || *photograph == *outline.image_sha256) return {};
  return Fail(ErrorCode::kOutlineOffSurface,
              "the outline was drawn on another photograph (" + outline.image_sha256->ToString().substr(0, 12) +
                  ") than this surface was made from (" + photograph->ToString().substr(0, 12) + "); draw it again");
}

Result<ScenePlus> BuildScene(const Surface& surface, const Outline& outline, const Options& options) {
  if (auto good = CheckInputs(surface, outline); !good) return Fail(good.error());
  const double reach_mm =
      1.3 * (std::min(options.gaps_mm.back(), kCoarseFrom_mm) + options.ring_width_mm);  // rings widen on slopes
  auto patch = CutPatch(surface, outline.polygon_px, options.cell_mm, reach_mm);
  if (!patch) return Fail(patch.error());
  ScenePlus plus;
  Scene& scene = plus.scene;
  scene.patch = *std::move(patch);
  const Polygon outline_px =
      Resample(ClosedCurve(outline.polygon_px), options.perimeter_step_mm / 2 / scene.patch.pixel_mm);
  const std::vector<double> distance = SensorDistances(scene.patch, outline_px);
  auto usable = SortCells(plus, distance, options);
  if (!usable) return Fail(usable.error());

  std::vector<Eigen::Vector3d> near_ring;
  for (std::size_t c = 0; c < scene.patch.size(); ++c) {
    if (scene.sheet[c] != 0 && distance[c] > options.gaps_mm.front() &&
        distance[c] < options.gaps_mm.front() + options.ring_width_mm) {
      near_ring.push_back(scene.patch.point[c]);
    }
  }
  if (near_ring.size() < 100) {
    return Fail(ErrorCode::kMeasurementRefused,
                "there is no healthy skin around the outline to continue across the wound; photograph a wider view");
  }
  scene.frame = FitFrame(near_ring);
  scene.outline = LayOnSkin(outline_px, scene, nullptr);
  Polygon drawn_mm = outline.polygon_px;
  for (auto& p : drawn_mm) p *= scene.patch.pixel_mm;
  plus.line = StudyLine(drawn_mm);
  Place(scene, *usable);
  // The skin moves the outline and the outline moves the ring: once more settles it well below a pixel.
  for (int round = 0; round < 2; ++round) {
    const Ring ring = TakeRing(scene, options.gaps_mm.front(), options.ring_width_mm);
    if (ring.points.size() < 100) {
      return Fail(ErrorCode::kMeasurementRefused,
                  "there is too little healthy skin around the outline; photograph a wider view");
    }
    const Skin skin = FitSkin(SkinModel::kQuadricC4, ring.points, WeighRing(ring.points));
    scene.outline = LayOnSkin(outline_px, scene, &skin);
    Place(scene, *usable);
  }
  return plus;
}

Result<Scene> CoarseScene(const Surface& surface, const Outline& outline, const Scene& fine, double cell_mm,
                          double reach_mm) {
  auto patch = CutPatch(surface, outline.polygon_px, cell_mm, reach_mm);
  if (!patch) return Fail(patch.error());
  Scene scene;
  scene.patch = *std::move(patch);
  scene.frame = fine.frame;
  scene.outline = Resample(fine.outline, cell_mm);
  const std::vector<double> distance = SensorDistances(scene.patch, outline.polygon_px);
  std::vector<std::uint8_t> outside(scene.patch.size()), seeds(scene.patch.size());
  for (std::size_t c = 0; c < scene.patch.size(); ++c) {
    outside[c] = distance[c] > 0 ? 1 : 0;
    seeds[c] = distance[c] > 0 && distance[c] < 3 * scene.patch.cell_mm() ? 1 : 0;
  }
  scene.sheet = ConnectedSheet(scene.patch, seeds, outside);
  Place(scene, scene.sheet);
  return scene;
}

}  // namespace striae::wound
