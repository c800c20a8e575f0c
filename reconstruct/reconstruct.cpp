#include "reconstruct/reconstruct.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/optics.h"
#include "core/vector.h"
#include "reconstruct/colour.h"
#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/lateral.h"
#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/sensor_grid.h"
#include "reconstruct/detail/triangulate.h"
#include "reconstruct/detail/uncertainty.h"
#include "reconstruct/misfit.h"
#include "reconstruct/quality.h"

namespace striae::reconstruct {
namespace {

/// Times the stages when there is a clock.
class Stages {
 public:
  Stages(Clock clock, std::vector<std::pair<std::string, double>>& seconds)
      : clock_(clock), seconds_(seconds), since_(clock != nullptr ? clock() : 0) {}
  void Done(const char* stage) {
    if (clock_ == nullptr) return;
    const double now = clock_();
    seconds_.emplace_back(stage, now - since_);
    since_ = now;
  }

 private:
  Clock clock_;
  std::vector<std::pair<std::string, double>>& seconds_;
  double since_;
};

Status CheckFit(const Photograph& photograph, const Calibration& calibration) {
  const int width = photograph.luminance.width(), height = photograph.luminance.height();
  if (width == calibration.image_width_px && height == calibration.image_height_px) return {};
  return Fail(ErrorCode::kCalibrationMismatch, "the photograph has " + std::to_string(width) + " x " +
                                                   std::to_string(height) + " pixels, the calibration is for " +
                                                   std::to_string(calibration.image_width_px) + " x " +
                                                   std::to_string(calibration.image_height_px) +
                                                   "; use the full-size original, and the calibration of this camera");
}

/// Of the working distance.
double Middle_mm(const Calibration& calibration) { return (calibration.near_mm + calibration.far_mm) / 2; }

/// Stripes go on along the line on either side, if across a gap as between a wound's edge and its bed. Where they end
/// for good, at a silhouette, the window sees more dark than stripes, and errors are three times what the misfit says.
bool IsInside(const PhaseResult& phase, int col, int row) {
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  const auto goes_on = [&](int side) {
    for (const double periods : {1.0, 1.5, 2.0, 2.5}) {
      const int away = static_cast<int>(std::lround(side * periods * phase.carrier_period_px));
      const int x = horizontal ? col : col + away, y = horizontal ? row + away : row;
      if (!phase.mask.Contains(x, y) || phase.mask(x, y) != 0) return true;
    }
    return false;
  };
  return goes_on(-1) && goes_on(1);
}

/// Absolute order of every pixel, in the place of the unwrapped phase; NaN outside the mask, where the light does not
/// fit, in regions without an order, and beyond the grating's light.
ImageF AbsoluteOrder(PhaseResult& phase, const std::vector<RegionOrder>& regions, const Calibration& calibration,
                     double most_misfit_inside) {
  constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
  // The surface ends a quarter of a stripe inside the centres of the first and the last bright stripe: the light ends
  // half a stripe beyond them, and near its end the window mixes lit with unlit, which bends the phase by millimetres
  // of depth. A quarter stripe takes 0.4 % (1 m) and 0.8 % (2 m) of the points and a fifth of their sd.
  constexpr float kEnd = 0.25F;
  const float lowest = calibration.stripes ? kEnd : -std::numeric_limits<float>::infinity();
  const float highest = calibration.stripes ? static_cast<float>(*calibration.stripes) - 1 - kEnd
                                            : std::numeric_limits<float>::infinity();
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  ImageF order = std::move(phase.unwrapped.phase);
  // Of no region at its place 0, of region r at r + 1.
  std::vector<float> offsets(regions.size() + 1, kNone);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (regions[r].source != OrderSource::kNone) offsets[r + 1] = static_cast<float>(regions[r].offset);
  }
  const std::uint8_t most_inside = KeptMisfit(most_misfit_inside);
  detail::ParallelLines(order.height(), [&](int row) {
    float* at = order.Row(row);
    const std::int32_t* region = phase.unwrapped.region.Row(row);
    const std::uint8_t* misfit = phase.misfit.Row(row);
    const detail::Extent extent = detail::ExtentOf(at, order.width());
    for (int col = extent.first; col < extent.last; ++col) {
      const float n = at[col] / kTwoPi + offsets[static_cast<std::size_t>(region[col] + 1)];
      const bool fits = misfit[col] <= phase.most_misfit || (misfit[col] <= most_inside && IsInside(phase, col, row));
      at[col] = fits && n >= lowest && n <= highest ? n : kNone;
    }
  });
  return order;
}

/// Where the stripes leave so much unexplained there are none: the window carries them on beyond an outline. On
/// rendered bodies this counts the lit pixels to 1 %.
constexpr std::uint8_t kNoStripes = 140;  // 255 sqrt(0.3)

STRIAE_VECTORISED std::size_t CountLit(const float* amplitude, const float* background, const std::uint8_t* misfit,
                                       int width, float lit) {
  constexpr float kLitModulation = 0.05F;
  std::uint32_t count = 0;
  for (int x = 0; x < width; ++x) {
    const bool bright = (amplitude[x] > lit) & (amplitude[x] > kLitModulation * background[x]);
    count += bright & (misfit[x] < kNoStripes) ? 1 : 0;
  }
  return count;
}

/// The lit field: pixels whose local mean is well above the scene's dark and that the carrier reaches at all.
std::size_t LitField(const PhaseResult& phase) {
  std::vector<float> amplitudes;
  for (std::size_t i = 0; i < phase.mask.size(); i += 31) {
    if (phase.mask.pixels()[i] != 0) amplitudes.push_back(phase.amplitude.pixels()[i]);
  }
  if (amplitudes.empty()) return 0;
  const auto middle = amplitudes.begin() + static_cast<long>(amplitudes.size() / 2);
  std::nth_element(amplitudes.begin(), middle, amplitudes.end());
  const float lit = 0.1F * *middle;
  constexpr int kEvery = 4;  // rows: the field has thousands of them
  std::vector<std::size_t> in_row(static_cast<std::size_t>((phase.mask.height() + kEvery - 1) / kEvery), 0);
  detail::ParallelLines(static_cast<int>(in_row.size()), [&](int k) {
    in_row[static_cast<std::size_t>(k)] = CountLit(phase.amplitude.Row(k * kEvery), phase.background.Row(k * kEvery),
                                                   phase.misfit.Row(k * kEvery), phase.mask.width(), lit);
  });
  return kEvery * std::accumulate(in_row.begin(), in_row.end(), std::size_t{0});
}

void CollectWarnings(double saturated_share, SensorReconstruction& out) {
  constexpr double kSaturated = 0.002, kNoteworthy = 0.02;
  if (saturated_share > kSaturated) {
    out.warnings.push_back(std::to_string(100 * saturated_share).substr(0, 4) +
                           " % of the photograph is saturated and carries no phase; lower the ISO");
  }
  std::size_t all = 0;
  for (const RegionOrder& region : out.regions) all += region.points;
  for (const RegionOrder& region : out.regions) {
    if (region.warning.empty() || static_cast<double>(region.points) < kNoteworthy * static_cast<double>(all)) continue;
    out.warnings.push_back("region of " + std::to_string(region.points) + " pixels: " + region.warning);
  }
  for (const std::string& warning : out.warnings) out.surface.comments.push_back(WarningComment(warning));
}

void TellOfCalibration(const Calibration& calibration, SensorReconstruction& out) {
  constexpr int kAcross = 8;  // places in either direction: it changes slowly
  const ImageF& depth = out.surface.depth();
  std::vector<PixelDepth> points;
  for (int k = 0; k < kAcross * kAcross; ++k) {
    const int col = (2 * (k % kAcross) + 1) * depth.width() / (2 * kAcross);
    const int row = (2 * (k / kAcross) + 1) * depth.height() / (2 * kAcross);
    const float z = depth(col, row);
    if (!std::isnan(z)) points.push_back({static_cast<double>(col), static_cast<double>(row), static_cast<double>(z)});
  }
  out.of_calibration = DepthUncertaintyOf(calibration, points);
  if (!out.of_calibration) return;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "calibration uncertainty mm median %.4f largest %.4f",
                out.of_calibration->median_mm, out.of_calibration->largest_mm);
  out.surface.comments.emplace_back(text.data());
}

/// The order of every pixel, and whatever is said of the photograph as a whole.
ImageF OrderOf(const Photograph& photograph, PhaseResult& phase, const Calibration& calibration,
               const ReconstructOptions& options, SensorReconstruction& out) {
  out.carrier_period_px = phase.carrier_period_px;
  out.local_periods = FollowPeriod(phase);
  out.direction = phase.direction;
  out.warnings = JudgePhotograph(photograph, phase).warnings;
  if (options.label_side_mm && options.find_target != nullptr) {
    out.target = options.find_target(phase, calibration.camera, *options.label_side_mm);
    if (!out.target) out.warnings.emplace_back("the label is not found in the photograph");
  }
  out.regions = SettleOrder(phase, photograph.colour, calibration, options.distance_mm.value_or(Middle_mm(calibration)),
                            out.target);
  return detail::SmoothAlongStripes(
      AbsoluteOrder(phase, out.regions, calibration, MostMisfitInside(calibration, options)), phase.direction,
      options.smoothing_along * phase.carrier_period_px);
}

}  // namespace

double MostMisfitInside(const Calibration& calibration, const ReconstructOptions& options) {
  constexpr double kLargest = 0.4;  // more is left where there are no stripes
  const double stripe_mm =
      std::abs(StripeOptics(calibration).DepthPerStripe(Eigen::Vector3d::UnitZ(), Middle_mm(calibration)));
  const double misfit = options.most_misfit_mm / (detail::kStripesOfMisfit * stripe_mm);
  return std::max(options.phase.most_misfit, std::min(kLargest, misfit));
}

Result<SensorReconstruction> ReconstructOnSensor(Photograph photograph, const Calibration& calibration,
                                                 const ReconstructOptions& options, Clock clock) {
  if (const Status fit = CheckFit(photograph, calibration); !fit) return Fail(fit.error());
  SensorReconstruction out;
  Stages stages(clock, out.seconds);
  PhaseOptions phase_options = options.phase;
  phase_options.direction = calibration.direction;
  auto phase = MeasurePhase(std::move(photograph), phase_options);
  if (!phase) return Fail(phase.error());
  stages.Done("phase");

  ImageF order = OrderOf(photograph, *phase, calibration, options, out);
  const std::size_t field = LitField(*phase);
  phase->unwrapped = {};  // an image of this size is 50 MB: what is done with makes room
  phase->mask = {};
  stages.Done("order");

  PointImages images;
  images.colour = ColourWithoutStripes(std::move(photograph.colour), order, phase->direction);
  stages.Done("colour");

  detail::OrderUncertainty(phase->misfit, phase->usual_misfit, phase->noise, phase->amplitude, phase->background);
  images.uncertainty = std::move(phase->amplitude);
  images.modulation = std::move(phase->background);
  const double slack_mm = options.outside_working_share * Middle_mm(calibration);
  detail::RayTable rays(calibration.camera, order.width(), order.height());
  images.depth = detail::Triangulate(std::move(order), calibration, rays, calibration.near_mm - slack_mm,
                                     calibration.far_mm + slack_mm, images.uncertainty);
  stages.Done("triangulation");
  out.surface = SensorSurface(
      std::make_unique<SensorSurface::Grid>(std::move(images), calibration.camera, std::move(rays), options.faces));
  stages.Done("mesh");
  if (out.surface.points() == 0) {
    return Fail(ErrorCode::kMeasurementRefused, "no point lies within the working distance of " +
                                                    std::to_string(std::lround(calibration.near_mm)) + " to " +
                                                    std::to_string(std::lround(calibration.far_mm)) +
                                                    " mm; check the distance and that the calibration is this rig's");
  }
  out.coverage =
      std::min(1.0, static_cast<double>(out.surface.points()) / static_cast<double>(std::max<std::size_t>(1, field)));
  TellOfCalibration(calibration, out);
  CollectWarnings(phase->saturated_share, out);
  out.surface.comments.push_back("carrier period px " + std::to_string(out.carrier_period_px));
  return out;
}

Result<Reconstruction> Reconstruct(Photograph photograph, const Calibration& calibration,
                                   const ReconstructOptions& options, Clock clock) {
  auto made = ReconstructOnSensor(std::move(photograph), calibration, options, clock);
  if (!made) return Fail(made.error());
  Stages stages(clock, made->seconds);
  Surface surface = std::move(made->surface).ToSurface();
  stages.Done("lists");
  Reconstruction out{std::move(static_cast<ReconstructionReport&>(*made)), std::move(surface)};
  return out;
}

}  // namespace striae::reconstruct
