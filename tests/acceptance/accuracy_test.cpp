// What the toolkit promises of a rig that it has never seen: calibrated from its own photographs of a reference plate,
// then bodies of known shape. Everything goes through JPEG; no point is left out of any figure.
#include <cmath>
#include <cstdio>
#include <iostream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/reconstruct.h"
#include "reconstruct/verify/verify.h"
#include "tests/acceptance/trials.h"

namespace striae::testing {
namespace {

using nlohmann::json;
using rig::Range;

/// Millimetres: the bars of docs/measured.md. The paper's apparatus had sd 0.5 mm at 1 m and 1.4 mm at 2 m.
struct Bars {
  double reference_sd, form_sd, distance, coverage;
};
Bars BarsOf(const Trials& trials, double scale) {
  Bars bars = trials.small() ? Bars{0.08, 0.10, 2, 0.93} : Bars{0.5, 0.5, 8, 0.93};
  // The sd is made at the caps' rims, and a rim is blurred by the pixel too: four times as wide on a quarter sensor.
  if (scale < 1) bars.reference_sd *= 1.2;
  return bars;
}

struct Body {
  std::string scene, photograph;
  std::vector<std::string> options;
};

struct Measured {
  reconstruct::Reconstruction result;
  ErrorFigures figures;
  double coverage = 0;
  std::string source;
};

Measured Measure(Trials& trials, const Calibration& calibration, const Body& body,
                 const reconstruct::ReconstructOptions& options = {}) {
  const Shot shot = Trials::Read(trials.Scene(body.scene, body.options), body.photograph);
  auto result = reconstruct::Reconstruct(shot.photograph, calibration, options);
  if (!result) throw std::runtime_error(body.scene + ": " + result.error().message);
  Measured measured{*std::move(result)};
  measured.figures = FiguresOf(PointErrors(measured.result.surface, shot.depth_mm));
  measured.coverage = CoverageOf(measured.result.surface, shot.lit);
  measured.source = ToString(measured.result.regions.front().source);
  return measured;
}

void Print(const std::string& what, const Measured& m, double form_sd) {
  std::printf("  %-22s depth: mean %7.3f  sd %6.3f  |median| %6.4f  p90 %6.4f mm", what.c_str(), m.figures.mean,
              m.figures.sd, m.figures.median_abs, m.figures.p90_abs);
  if (form_sd > 0) std::printf("  form sd %6.4f mm", form_sd);
  std::printf("  lit covered %5.1f %%  order %s\n", 100 * m.coverage, m.source.c_str());
  std::fflush(stdout);
}

/// Calibrates one unknown rig and measures plane, ball and body with what it found.
void TryRig(Range range, std::uint32_t seed, double scale, const std::string& iso) {
  Trials trials(range, seed, scale);
  const Bars bars = BarsOf(trials, scale);
  const json report = json::parse(trials.Calibrate());
  const Calibration own = trials.Own();
  std::printf("%s rig %u, ISO %s: reference sd %.4f mm (robust %.4f), coverage %.1f %%\n", NameOf(range).c_str(), seed,
              iso.c_str(), report.at("sd_mm").get<double>(), report.at("robust_sd_mm").get<double>(),
              100 * report.at("coverage").get<double>());
  EXPECT_LT(report.at("sd_mm").get<double>(), bars.reference_sd);
  EXPECT_GT(report.at("coverage").get<double>(), bars.coverage);

  const Measured plane = Measure(trials, own, {"plane", "plane", {"--tilt-x", "7", "--tilt-y", "-5", "--iso", iso}});
  const auto flat = reconstruct::CheckPlane(plane.result.surface, {});
  ASSERT_TRUE(flat) << flat.error().message;
  Print("plane, tilted", plane, flat->sd_mm);
  EXPECT_LT(flat->sd_mm, bars.form_sd);
  EXPECT_LT(std::abs(plane.figures.mean), bars.distance);
  EXPECT_GT(plane.coverage, bars.coverage);

  // A ball shows no end of the grating, so it is told the distance as a tape finds it: 3 mm off, a fifth of a stripe.
  const double diameter = trials.small() ? 150 : 300;
  reconstruct::ReconstructOptions taped;
  taped.distance_mm = (trials.small() ? 1000 : 2000) + diameter / 8 - 3;
  const Measured ball = Measure(trials, own, {"ball", "ball", {"--iso", iso, "--y-mm", "4"}}, taped);
  const auto form = reconstruct::CheckBall(ball.result.surface, diameter, {});
  ASSERT_TRUE(form) << form.error().message;
  Print("ball", ball, form->sd_mm);
  EXPECT_LT(form->sd_mm, bars.form_sd);
  EXPECT_LT(std::abs(ball.figures.median), bars.distance);

  const Measured body = Measure(
      trials, own, trials.small() ? Body{"limb", "limb", {"--iso", iso}} : Body{"bust", "neutral", {"--iso", iso}});
  Print(trials.small() ? "limb with wound" : "bust", body, 0);
  EXPECT_LT(std::abs(body.figures.median), bars.distance);
}

TEST(AccuracyLong, OneMetreWithARigUnknownToTheCode) { TryRig(Range::kSmall, 1, 1, "400"); }
TEST(AccuracyLong, OneMetreWithAnotherRig) { TryRig(Range::kSmall, 2, 1, "200"); }
TEST(AccuracyLong, TwoMetresWithARigUnknownToTheCode) { TryRig(Range::kLarge, 1, 1, "400"); }
TEST(AccuracyLong, TwoMetresWithAnotherRig) { TryRig(Range::kLarge, 2, 1, "500"); }

TEST(Accuracy, TwoMetresOnAQuarterOfTheSensor) { TryRig(Range::kLarge, 3, 0.25, "400"); }

}  // namespace
}  // namespace striae::testing
