#include "app/calibrating.h"

#include <algorithm>

#include <fmt/format.h>

#include "acquire/metadata.h"
#include "app/io/files.h"
#include "app/io/photograph.h"
#include "core/ply.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {

namespace fs = std::filesystem;

Result<CalibrationPhotograph> OpenForCalibration(const fs::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), path.string());
  CalibrationPhotograph opened{std::move(*photograph), HashOf(*bytes), {}};
  if (const auto metadata = acquire::ReadMetadata(*bytes)) opened.focal_length_mm = metadata->focal_length_mm;
  return opened;
}

Result<reconstruct::ReferenceShape> ReadReference(const fs::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  const auto mesh = DecodePly(*bytes);
  if (!mesh) return Fail(mesh.error(), path.string());
  auto shape = reconstruct::ReferenceShape::FromMesh(*mesh);
  if (!shape) return Fail(shape.error(), path.string());
  return shape;
}

Result<std::vector<reconstruct::CalibrationStep>> ReadSteps(const fs::path& path) {
  const auto text = ReadText(path);
  if (!text) return Fail(text.error());
  auto steps = reconstruct::ParseSteps(*text);
  if (!steps) return Fail(steps.error(), path.string());
  return steps;
}

reconstruct::NominalRig NominalOf(const CalibratingOptions& options, double nearest_mm) {
  reconstruct::NominalRig nominal;
  nominal.projector_focal_mm = options.projector_focal_mm;
  nominal.grating_period_mm = options.period_um / 1000;
  nominal.stripes = options.stripes;
  nominal.first_distance_mm = nearest_mm;
  return nominal;
}

Status AdoptCamera(const CalibrationPhotograph& opened, bool first, const CalibratingOptions& options,
                   reconstruct::NominalRig& nominal) {
  const int width = opened.photograph.luminance.width(), height = opened.photograph.luminance.height();
  if (first) {
    nominal.image_width_px = width;
    nominal.image_height_px = height;
    nominal.pixel_pitch_mm = options.sensor_width_mm / std::max(width, height);
    nominal.camera_focal_mm = opened.focal_length_mm.value_or(nominal.camera_focal_mm);
    return {};
  }
  if (width == nominal.image_width_px && height == nominal.image_height_px) return {};
  return Fail(ErrorCode::kBadCalibration,
              fmt::format("the photograph has {} x {} pixels, the first one {} x {}; all must come from one camera at "
                          "full size",
                          width, height, nominal.image_width_px, nominal.image_height_px));
}

double ModulationOf(const reconstruct::PhaseResult& phase) {
  std::vector<float> values;
  for (std::size_t i = 0; i < phase.mask.size(); i += 37) {  // a prime: no column or stripe is preferred
    if (phase.mask.pixels()[i] != 0) values.push_back(phase.ModulationAt(i));
  }
  return reconstruct::SpreadOf(std::move(values)).median;
}

Status CheckSharpness(const std::vector<Shot>& shots) {
  constexpr double kLeastShare = 0.6;
  std::vector<float> values;
  for (const Shot& shot : shots) values.push_back(static_cast<float>(shot.modulation));
  const double usual = reconstruct::SpreadOf(std::move(values)).median;
  for (const Shot& shot : shots) {
    if (shot.modulation >= kLeastShare * usual) continue;
    return Fail(ErrorCode::kBadCalibration,
                fmt::format("{}: its stripes are faint (modulation {:.2f}, the others' {:.2f}); it is out of focus, "
                            "shaken or lit by the room: take it again",
                            shot.path.string(), shot.modulation, usual));
  }
  return {};
}

Status MeasureAll(const std::vector<reconstruct::CalibrationStep>& steps, const CalibratingOptions& options,
                  const reconstruct::ReferenceShape& shape, ProgressBar& bar, Calibrating& work) {
  for (const auto& step : steps) {
    bar.Show(2 * work.shots.size(), 5 * steps.size(), "phase of " + step.image);
    Shot shot;
    shot.image = step.image;
    shot.path = options.steps.parent_path() / step.image;
    const auto opened = OpenForCalibration(shot.path);
    if (!opened) return Fail(opened.error());
    shot.sha256 = opened->sha256;
    const bool first = work.shots.empty();
    if (Status same = AdoptCamera(*opened, first, options, work.nominal); !same) {
      return Fail(same.error(), shot.path.string());
    }
    const auto phase = reconstruct::MeasurePhase(opened->photograph);
    if (!phase) return Fail(phase.error(), shot.path.string());
    shot.carrier_period_px = phase->carrier_period_px;
    shot.modulation = ModulationOf(*phase);
    if (first) work.nominal.direction = phase->direction;
    if (phase->direction != work.nominal.direction) {
      return Fail(ErrorCode::kBadCalibration,
                  shot.path.string() + ": the stripes run across those of the first photograph");
    }
    work.views.push_back(reconstruct::ViewFromPhase(*phase, step.position_mm));
    reconstruct::NominalRig there = work.nominal;  // CheckObject looks at the nominal distance
    there.first_distance_mm += step.position_mm - work.nearest_position_mm;
    if (Status shown = reconstruct::CheckObject(shape, work.views.back(), there); !shown) {
      return Fail(shown.error(), shot.path.string());
    }
    work.shots.push_back(std::move(shot));
  }
  return CheckSharpness(work.shots);
}

Status Evaluate(const reconstruct::ReferenceShape& shape, const reconstruct::CalibrationFit& fit, ProgressBar& bar,
                Calibrating& work) {
  std::vector<float> all;
  double lit = 0;
  for (std::size_t i = 0; i < work.shots.size(); ++i) {
    Shot& shot = work.shots[i];
    bar.Show(3 * work.shots.size() + 2 * i, 5 * work.shots.size(), "surface of " + shot.image);
    const auto opened = OpenForCalibration(shot.path);
    if (!opened) return Fail(opened.error());
    reconstruct::ReconstructOptions settings;
    settings.faces = false;
    // Where the object stands is known here, should a photograph not show the grating's edge.
    settings.distance_mm = fit.PointInCamera((shape.lowest() + shape.highest()) / 2, work.views[i].position_mm).z();
    const auto surface = reconstruct::Reconstruct(opened->photograph, fit.calibration, settings);
    if (!surface) return Fail(surface.error(), shot.path.string());
    auto found = reconstruct::CompareWithReference(surface->surface, fit, shape, work.views[i].position_mm);
    shot.order_source = surface->regions.front().source;
    shot.order_margin = surface->regions.front().margin;
    const double field = static_cast<double>(surface->surface.size()) / std::max(1e-9, surface->coverage);
    shot.coverage = static_cast<double>(found.values_mm.size()) / field;
    lit += field;
    all.insert(all.end(), found.values_mm.begin(), found.values_mm.end());
    work.panels.push_back({fmt::format("{}  {:g} mm", shot.image, work.views[i].position_mm), std::move(found.map_mm)});
    shot.spread = reconstruct::SpreadOf(std::move(found.values_mm));
  }
  work.coverage = static_cast<double>(all.size()) / lit;
  work.all = reconstruct::SpreadOf(std::move(all));
  return {};
}

}  // namespace striae::app
