// `striae reconstruct`: one photograph and a calibration -> a coloured surface.
#include "reconstruct/reconstruct.h"

#include <functional>
#include <optional>

#include "app/command.h"
#include "app/io/files.h"
#include "app/io/phase_preview.h"
#include "app/io/photograph.h"
#include "app/io/preview.h"
#include "app/io/surface_files.h"
#include "app/reconstructing.h"
#include "reconstruct/white_balance.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path image, calibration, out, preview;
  std::vector<fs::path> also;
  std::string format, white_balance = "as-shot";
  double distance_mm = 0, label_mm = 0;
  std::size_t decimate = 0;
  bool no_faces = false;
};

/// A file to write, as the options name it.
struct Target {
  fs::path path;
  SurfaceFormat format = SurfaceFormat::kPly;
  bool decimated = false;
};

/// Where everything goes, checked before anything is computed.
Result<std::vector<Target>> TargetsOf(const Options& options) {
  const bool decimate = options.decimate > 0;
  if (options.no_faces && decimate) return Fail(ErrorCode::kUsage, "--decimate needs faces; leave out --no-faces");
  // A name of any kind is a PLY unless it says otherwise, as it has always been.
  auto format = FormatOf(options.out, options.format);
  if (!format && !options.format.empty()) return Fail(format.error());
  const SurfaceFormat first = format ? *format : SurfaceFormat::kPly;
  std::vector<Target> targets = {{options.out, first, decimate && first != SurfaceFormat::kPly}};
  for (const fs::path& path : options.also) {
    format = FormatOf(path, "");
    if (!format) return Fail(format.error());
    targets.push_back({path, *format, decimate});
  }
  for (const Target& target : targets) {
    if (Status writable = CheckWritable(target.path); !writable) return Fail(writable.error());
    if (options.no_faces && target.format != SurfaceFormat::kPly) {
      return Fail(ErrorCode::kUsage, "STL and OBJ are made of faces; leave out --no-faces");
    }
  }
  return targets;
}

/// Writes all or nothing; what was made of the decimation goes into `document`.
Status WriteTargets(const std::vector<Target>& targets, const Surface& surface, std::size_t faces,
                    nlohmann::json& document) {
  std::optional<DecimatedSurface> decimated;
  std::vector<fs::path> written;
  const auto write = [&](const Target& target) -> Status {
    if (target.decimated && !decimated) {
      auto made = DecimateForFile(surface, faces);
      if (!made) return Fail(made.error());
      decimated = *std::move(made);
      document["decimated"] = {{"faces", decimated->surface.faces.size()},
                               {"points", decimated->surface.size()},
                               {"deviation_max_mm", decimated->deviation_largest_mm},
                               {"deviation_rms_mm", decimated->deviation_rms_mm}};
    }
    const auto files = WriteSurface(target.decimated ? decimated->surface : surface, target.path, target.format);
    if (!files) return Fail(files.error());
    written.insert(written.end(), files->begin(), files->end());
    return {};
  };
  for (const Target& target : targets) {
    if (Status done = write(target); !done) {
      std::error_code code;
      for (const fs::path& file : written) fs::remove(file, code);
      return done;
    }
  }
  for (const fs::path& file : written) document["files"].push_back(file.string());
  return {};
}

Status WritePreviews(const fs::path& folder, const Photograph& photograph, const Calibration& calibration,
                     const Surface& surface) {
  std::error_code code;
  fs::create_directories(folder, code);
  reconstruct::PhaseOptions same;
  same.direction = calibration.direction;
  const auto phase = reconstruct::MeasurePhase(photograph, same);
  if (!phase) return Fail(phase.error());
  const std::pair<const char*, std::function<Result<std::vector<std::uint8_t>>()>> pictures[] = {
      {"photo.png", [&] { return PhotographPreview(photograph.colour); }},
      {"depth.png", [&] { return DepthPreview(surface); }},
      {"shaded.png", [&] { return ShadedPreview(surface); }},
      {"phase.png", [&] { return PhasePreview(*phase); }},
      {"mask.png", [&] { return MaskPreview(photograph, reconstruct::MeasuredMask(*phase)); }},
      {"modulation.png", [&] { return ModulationPreview(*phase); }}};
  for (const auto& [name, draw] : pictures) {
    const auto png = draw();
    if (!png) return Fail(png.error());
    if (Status written = WriteFile(folder / name, *png, Kept::kSystem); !written) return written;
  }
  return {};
}

Status Reconstruct(Context& context, const Options& options) {
  const auto targets = TargetsOf(options);
  if (!targets) return Fail(targets.error());
  const auto balance = reconstruct::WhiteBalanceFrom(options.white_balance);
  if (!balance) return Fail(balance.error());
  Sha256 calibration_sha256;
  const auto calibration = ReadCalibration(options.calibration, calibration_sha256);
  if (!calibration) return Fail(calibration.error());
  const double start = Now();
  const auto bytes = ReadFile(options.image);
  if (!bytes) return Fail(bytes.error());
  auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), options.image.string());
  const double decoded = Now();
  const Sha256 photograph_sha256 = HashOf(*bytes);

  reconstruct::ReconstructOptions settings;
  if (options.distance_mm > 0) settings.distance_mm = options.distance_mm;
  settings.faces = !options.no_faces;
  if (options.label_mm > 0) {
    settings.label_side_mm = options.label_mm;
    settings.find_target = reconstruct::FindTarget;
  }
  // The previews need the photograph again; without them its memory is used for the surface.
  auto result = reconstruct::Reconstruct(options.preview.empty() ? *std::move(photograph) : *photograph, *calibration,
                                         settings, Now);
  if (!result) return Fail(result.error(), options.image.string());
  SayWhatItIsMadeOf(photograph_sha256, calibration_sha256, result->surface.comments);
  if (const auto gains = reconstruct::Balance(*balance, result->surface); !gains) return Fail(gains.error());
  const double reconstructed = Now();
  nlohmann::json files;
  if (Status written = WriteTargets(*targets, result->surface, options.decimate, files); !written) return written;
  result->seconds.insert(result->seconds.begin(), {"decode", decoded - start});
  result->seconds.emplace_back("write", Now() - reconstructed);
  result->seconds.emplace_back("total", Now() - start);
  if (!options.preview.empty()) {
    Status written = WritePreviews(options.preview, *photograph, *calibration, result->surface);
    if (!written) return written;
  }
  Announce(context, *result, {result->surface.size(), result->surface.faces.size()}, files, options.out);
  return {};
}

}  // namespace

void AddCommand_reconstruct(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "reconstruct", "Compute a coloured surface (mm) from one photograph",
                 "striae reconstruct DSC_0001.JPG --calibration small.json --out limb.ply --also limb.obj "
                 "--decimate 50000 --preview pictures");
  auto options = std::make_shared<Options>();
  command->add_option("image", options->image, "Photograph: JPEG, PNG, TIFF, BMP, NEF or DNG")->required();
  command->add_option("--calibration", options->calibration, "Calibration of the rig (JSON)")->required();
  command->add_option("--out", options->out, "Surface to write: .ply, .stl or .obj (with .mtl and .jpg)")->required();
  command->add_option("--also", options->also, "Further files to write, by their extension");
  command->add_option("--format", options->format, "Format of --out whatever its name")
      ->check(CLI::IsMember({"ply", "stl", "obj"}));
  command
      ->add_option("--decimate", options->decimate,
                   "Most faces of STL, OBJ and all of --also (the PLY of --out keeps every point); the deviation is "
                   "measured")
      ->check(CLI::Range(std::size_t{4}, std::size_t{100'000'000}));
  command
      ->add_option("--white-balance", options->white_balance,
                   "as-shot, grey-world, white-patch or grey-card=COL,ROW (a sensor pixel on the card)")
      ->capture_default_str();
  command->add_option("--distance-mm", options->distance_mm, "Distance of the subject, if known better than the rig's")
      ->check(CLI::PositiveNumber);
  command->add_option("--label-mm", options->label_mm, "Side of the printed label in view (striae print label), mm")
      ->check(CLI::PositiveNumber);
  command->add_option("--preview", options->preview, "Folder for photo, shaded, depth, phase, mask and modulation.png");
  command->add_flag("--no-faces", options->no_faces, "Write points only");
  OnRun(command, context, [options](Context& run) { return Reconstruct(run, *options); });
}

}  // namespace striae::app
