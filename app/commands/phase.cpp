// `striae phase`: the unwrapped phase of any fringe photograph; no calibration needed.
#include "reconstruct/phase.h"

#include <limits>

#include <fmt/format.h>

#include "app/command.h"
#include "app/io/files.h"
#include "app/io/images.h"
#include "app/io/photograph.h"
#include "app/io/surface_files.h"
#include "reconstruct/quality.h"

namespace striae::app {
namespace {

struct Options {
  std::filesystem::path image, out, mask;
  reconstruct::BandWindow window;
};

Status WriteImages(const Options& options, ImageF phase, const Mask& measured) {
  for (std::size_t i = 0; i < phase.size(); ++i) {
    if (measured.pixels()[i] == 0) phase.pixels()[i] = std::numeric_limits<float>::quiet_NaN();
  }
  const auto tiff = EncodeFloatTiff(phase);
  if (!tiff) return Fail(tiff.error());
  if (Status written = WriteFile(options.out, *tiff); !written) return written;
  if (options.mask.empty()) return {};
  const auto png = EncodeMaskPng(measured);
  if (!png) return Fail(png.error());
  return WriteFile(options.mask, *png);
}

Status MeasurePhase(Context& context, const Options& options) {
  if (Status writable = CheckWritable(options.out); !writable) return writable;
  const auto bytes = ReadFile(options.image);
  if (!bytes) return Fail(bytes.error());
  const auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), options.image.string());
  reconstruct::PhaseOptions settings;
  settings.window = options.window;
  const auto phase = reconstruct::MeasurePhase(*photograph, settings);
  if (!phase) return Fail(phase.error(), options.image.string());
  const Mask measured = reconstruct::MeasuredMask(*phase);
  if (Status written = WriteImages(options, phase->unwrapped.phase, measured); !written) return written;

  std::size_t valid = 0;
  for (const std::uint8_t m : measured.pixels()) valid += m;
  const auto quality = reconstruct::JudgePhotograph(*photograph, *phase);
  for (const std::string& warning : quality.warnings) context.Note("warning: " + warning);
  const reconstruct::LocalPeriods periods = reconstruct::FollowPeriod(*phase);
  const nlohmann::json document = {{"direction", ToString(phase->direction)},
                                   {"carrier_period_px", phase->carrier_period_px},
                                   {"local_period_px", {periods.fifth_px, periods.ninety_fifth_px}},
                                   {"carrier_prominence", phase->carrier_prominence},
                                   {"points", valid},
                                   {"regions", phase->unwrapped.regions},
                                   {"saturated_share", phase->saturated_share},
                                   {"modulation", quality.modulation},
                                   {"warnings", quality.warnings}};
  context.Output(document,
                 fmt::format("{}: {} stripes every {:.2f} px, {} pixels in {} regions", options.out.string(),
                             ToString(phase->direction), phase->carrier_period_px, valid, phase->unwrapped.regions));
  return {};
}

}  // namespace

void AddCommand_phase(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "phase", "Measure the unwrapped phase of any fringe photograph",
                                 "striae phase fringes.png --out phase.tiff --mask mask.png");
  auto options = std::make_shared<Options>();
  command->add_option("image", options->image, "Photograph: JPEG, PNG, TIFF, BMP, NEF or DNG")->required();
  command->add_option("--out", options->out, "Phase to write (TIFF, float32, radians, NaN where invalid)")->required();
  command->add_option("--mask", options->mask, "Mask to write (PNG, 255 = valid)");
  command->add_option("--window", options->window.half_width, "Half width of the window over the carrier's frequency")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  command->add_flag("!--hann", options->window.flattened,
                    "Use a plain Hann window, rounder than the flattened one of the default");
  OnRun(command, context, [options](Context& run) { return MeasurePhase(run, *options); });
}

}  // namespace striae::app
