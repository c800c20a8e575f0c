// What each refinement of the Fourier stage brings: the same photographs with one setting changed at a time. Depth
// errors with the true rig: sd of all points, median of the absolute errors, share of the lit pixels (or of the truth)
// that have a point. Photographs of the virtual rig always; the practice set and real photographs where they are
// present.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>

#include "app/io/photograph.h"
#include "core/optics.h"
#include "core/ply.h"
#include "reconstruct/reconstruct.h"
#include "tests/acceptance/trials.h"
#include "tests/support/depth_map.h"
#include "tests/support/files.h"
#include "tests/support/test_data.h"

namespace striae::testing {
namespace {

using reconstruct::ReconstructOptions;
using rig::Range;

struct Setting {
  std::string name;
  std::function<void(ReconstructOptions&)> change;
  bool decoded = true;  ///< sRGB to light
};

std::vector<Setting> Settings() {
  const auto none = [](ReconstructOptions&) {};
  return {{"default", none},
          {"plain Hann window, 0.5",
           [](ReconstructOptions& o) {
             o.phase.window = {0.5, false};
           }},
          {"plain Hann window, 0.9",
           [](ReconstructOptions& o) {
             o.phase.window = {0.9, false};
           }},
          {"window half width 0.7", [](ReconstructOptions& o) { o.phase.window.half_width = 0.7; }},
          {"window half width 1.0", [](ReconstructOptions& o) { o.phase.window.half_width = 1.0; }},
          {"no smoothing along the stripes", [](ReconstructOptions& o) { o.smoothing_along = 0; }},
          {"order smoothed, 1/8 period", [](ReconstructOptions& o) { o.smoothing_along = 0.125; }},
          {"light smoothed, 1/8 (2-D window)",
           [](ReconstructOptions& o) {
             o.smoothing_along = 0;
             o.phase.smoothing_along = 0.125;
           }},
          {"sRGB not decoded", none, false},
          {"background not removed", [](ReconstructOptions& o) { o.phase.remove_background = false; }},
          {"ends not trimmed", [](ReconstructOptions& o) { o.phase.rim_periods = 0; }},
          {"mask: no largest modulation", [](ReconstructOptions& o) { o.phase.most_modulation = 10; }},
          {"mask: any misfit", [](ReconstructOptions& o) { o.phase.most_misfit = 1; }},
          {"mask: misfit up to 0.1", [](ReconstructOptions& o) { o.phase.most_misfit = 0.1; }},
          {"mask: plateau share 0.2", [](ReconstructOptions& o) { o.phase.least_plateau_share = 0.2; }},
          {"mask: plateau share 0.55", [](ReconstructOptions& o) { o.phase.least_plateau_share = 0.55; }},
          {"mask: modulation share 0.2", [](ReconstructOptions& o) { o.phase.least_modulation_share = 0.2; }}};
}

struct Score {
  double sd = NAN, median = NAN, p90 = NAN, share = NAN;
};

/// A photograph, and how a setting's result on it is judged.
struct Subject {
  std::string name, unit;
  Photograph photograph;
  std::function<Score(const Photograph&, const ReconstructOptions&)> judge;
};

Score ScoreOf(const std::vector<PointError>& errors, double share) {
  const ErrorFigures f = FiguresOf(errors);
  return {f.sd, f.median_abs, f.p90_abs, share};
}

Calibration RigIn(const std::string& file) {
  auto rig = CalibrationFromJson(ReadText(TestData(file)));
  if (!rig) throw std::runtime_error(rig.error().message);
  return *std::move(rig);
}

Photograph Open(const std::string& file) {
  auto photograph = app::DecodePhotograph(ReadBytes(TestData(file)));
  if (!photograph) throw std::runtime_error(file + ": " + photograph.error().message);
  return *std::move(photograph);
}

Subject OfTheRig(Trials& trials, const std::string& name, const std::string& scene, const std::string& photograph,
                 const std::vector<std::string>& options) {
  const Shot shot = Trials::Read(trials.Scene(scene, options), photograph);
  const Calibration rig = trials.True();
  return {name, "mm", shot.photograph, [=](const Photograph& p, const ReconstructOptions& o) -> Score {
            const auto result = reconstruct::Reconstruct(p, rig, o);
            if (!result) return {};
            return ScoreOf(PointErrors(result->surface, shot.depth_mm), CoverageOf(result->surface, shot.lit));
          }};
}

/// Truth at every 8th pixel.
Subject OfThePracticeSet(const std::string& name, const std::string& image, const std::string& rig_file) {
  const Calibration rig = RigIn("practice/" + rig_file);
  const ImageF truth = ReadDepthMap(TestData("practice/" + image + ".depth8.tiff"));
  return {name, "mm", Open("practice/" + image + ".jpg"),
          [=](const Photograph& p, const ReconstructOptions& o) -> Score {
            const auto result = reconstruct::Reconstruct(p, rig, o);
            if (!result) return {};
            std::vector<PointError> errors;
            for (std::size_t i = 0; i < result->surface.size(); ++i) {
              const int col = result->surface.col[i], row = result->surface.row[i];
              if (col % kDepthMapStep_px != 0 || row % kDepthMapStep_px != 0) continue;
              const float depth = truth(col / kDepthMapStep_px, row / kDepthMapStep_px);
              if (depth > 0) errors.push_back({result->surface.point_in_camera[i].z() - depth, 0, col, row});
            }
            return ScoreOf(errors, result->coverage);
          }};
}

Subject David() {
  const Calibration rig = RigIn("david_bust/left.json");
  const auto truth = DecodePly(ReadBytes(TestData("david_bust/truth_left.ply")));
  if (!truth) throw std::runtime_error(truth.error().message);
  const Surface points = *truth;
  return {"david", "mm", Open("david_bust/left.png"), [=](const Photograph& p, const ReconstructOptions& o) -> Score {
            const auto result = reconstruct::Reconstruct(p, rig, o);
            if (!result) return {};
            const auto grid = VertexIndexGrid(result->surface);
            std::vector<PointError> errors;
            for (const auto& point : points.point_in_camera) {
              const Eigen::Vector2d pixel = Project(rig.camera, point.cast<double>());
              const int col = static_cast<int>(std::lround(pixel.x())), row = static_cast<int>(std::lround(pixel.y()));
              if (!grid.Contains(col, row) || grid(col, row) < 0) continue;
              const auto& found = result->surface.point_in_camera[static_cast<std::size_t>(grid(col, row))];
              errors.push_back({found.z() - point.z(), 0, col, row});
            }
            return ScoreOf(errors, static_cast<double>(errors.size()) / static_cast<double>(points.size()));
          }};
}

/// Phase of one frame against the four-step phase of all four, up to a constant.
Subject Lens() {
  std::vector<ImageF> frames;
  for (const char* step : {"000", "090", "180", "270"}) {
    frames.push_back(Open("lens_fringes/lens_crop_" + std::string(step) + ".jpg").luminance);
  }
  return {"lens", "rad", Open("lens_fringes/lens_crop_000.jpg"),
          [=](const Photograph& p, const ReconstructOptions& o) -> Score {
            const auto phase = reconstruct::MeasurePhase(p, o.phase);
            if (!phase) return {};
            std::vector<PointError> errors;
            Eigen::Vector2d sum = Eigen::Vector2d::Zero();
            for (int row = 0; row < phase->mask.height(); ++row) {
              for (int col = 0; col < phase->mask.width(); ++col) {
                if (phase->mask(col, row) == 0) continue;
                const float truth =
                    std::atan2(frames[1](col, row) - frames[3](col, row), frames[0](col, row) - frames[2](col, row));
                errors.push_back({phase->unwrapped.phase(col, row) - truth, 0, col, row});
                sum += Eigen::Vector2d(std::cos(errors.back().error_mm), std::sin(errors.back().error_mm));
              }
            }
            for (PointError& e : errors) {
              e.error_mm = std::remainder(e.error_mm - static_cast<float>(std::atan2(sum.y(), sum.x())),
                                          2 * std::numbers::pi_v<float>);
            }
            return ScoreOf(errors, static_cast<double>(errors.size()) / static_cast<double>(phase->mask.size()));
          }};
}

void Print(Subject subject) {
  std::printf("%s (%s)\n  %-34s %8s %9s %9s %8s\n", subject.name.c_str(), subject.unit.c_str(), "", "sd", "|median|",
              "|p90|", "covered");
  for (const Setting& setting : Settings()) {
    ReconstructOptions options;
    options.faces = false;
    setting.change(options);
    subject.photograph.linear = !setting.decoded;
    const Score s = subject.judge(subject.photograph, options);
    std::printf("  %-34s %8.4f %9.4f %9.4f %6.1f %%\n", setting.name.c_str(), s.sd, s.median, s.p90, 100 * s.share);
    std::fflush(stdout);
  }
}

void PrintAll() {
  {
    Trials trials(Range::kLarge, 3, 0.25);
    Print(OfTheRig(trials, "virtual rig: bust, 2 m, quarter sensor, ISO 400", "bust", "neutral", {"--iso", "400"}));
  }
  {
    Trials trials(Range::kSmall, 1);
    Print(OfTheRig(trials, "virtual rig: limb, 1 m, ISO 400", "limb", "limb", {"--iso", "400"}));
  }
  if (HasTestData("lens_fringes/lens_crop_000.jpg")) Print(Lens());
  if (HasTestData("david_bust/left.png")) Print(David());
  if (!HasTestData("practice/true_small.json")) return;
  Print(OfThePracticeSet("practice limb, 1 m", "wound_0/visit_0", "true_small.json"));
  Print(OfThePracticeSet("practice step, 1 m", "calibration/small_04", "true_small.json"));
  Print(OfThePracticeSet("practice step, 2 m", "calibration/large_03", "true_large.json"));
  Print(OfThePracticeSet("practice head, 2 m", "head/pose_0", "true_large.json"));
}

}  // namespace
}  // namespace striae::testing

int main() {
  try {
    striae::testing::PrintAll();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
