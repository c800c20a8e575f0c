// `striae reconstruct`: one photograph and a calibration -> a coloured surface.
#include "reconstruct/reconstruct.h"

#include <chrono>

#include <fmt/format.h>

#include "app/command.h"
#include "app/io/files.h"
#include "app/io/photograph.h"
#include "app/io/preview.h"
#include "core/ply.h"
#include "core/provenance.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path image, calibration, out, preview;
  double distance_mm = 0;
  bool no_faces = false;
};

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Result<Calibration> ReadCalibration(const fs::path& path, Sha256& sha256) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  sha256 = HashOf(*bytes);
  auto calibration = CalibrationFromJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!calibration) return Fail(calibration.error(), path.string());
  return calibration;
}

Status WritePreviews(const fs::path& folder, const Photograph& photograph, const Surface& surface) {
  std::error_code code;
  fs::create_directories(folder, code);
  const auto photo = PhotographPreview(photograph.colour);
  const auto depth = DepthPreview(surface);
  const auto shaded = ShadedPreview(surface);
  const struct {
    const char* name;
    const Result<std::vector<std::uint8_t>>& png;
  } pictures[] = {{"photo.png", photo}, {"depth.png", depth}, {"shaded.png", shaded}};
  for (const auto& [name, png] : pictures) {
    if (!png) return Fail(png.error());
    if (Status written = WriteFile(folder / name, *png); !written) return written;
  }
  return {};
}

nlohmann::json ToJson(const reconstruct::Reconstruction& r) {
  nlohmann::json document = {{"points", r.surface.size()},
                             {"faces", r.surface.faces.size()},
                             {"coverage", r.coverage},
                             {"carrier_period_px", r.carrier_period_px},
                             {"direction", ToString(r.direction)},
                             {"regions", nlohmann::json::array()},
                             {"warnings", r.warnings},
                             {"seconds", nlohmann::json::object()}};
  for (const auto& region : r.regions) {
    nlohmann::json entry = {
        {"points", region.points}, {"order_source", ToString(region.source)}, {"order_margin", region.margin}};
    if (!region.warning.empty()) entry["warning"] = region.warning;
    document["regions"].push_back(entry);
  }
  for (const auto& [stage, seconds] : r.seconds) document["seconds"][stage] = seconds;
  return document;
}

Status Reconstruct(Context& context, const Options& options) {
  Sha256 calibration_sha256;
  const auto calibration = ReadCalibration(options.calibration, calibration_sha256);
  if (!calibration) return Fail(calibration.error());
  const double start = Now();
  const auto bytes = ReadFile(options.image);
  if (!bytes) return Fail(bytes.error());
  const auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), options.image.string());
  const double decoded = Now();

  reconstruct::ReconstructOptions settings;
  if (options.distance_mm > 0) settings.distance_mm = options.distance_mm;
  settings.faces = !options.no_faces;
  auto result = reconstruct::Reconstruct(*photograph, *calibration, settings, Now);
  if (!result) return Fail(result.error(), options.image.string());
  result->surface.comments = {"striae " + std::string(StriaeVersion()),
                              "photograph sha256 " + HashOf(*bytes).ToString(),
                              "calibration sha256 " + calibration_sha256.ToString()};
  const double reconstructed = Now();
  if (Status written = WriteFile(options.out, EncodePly(result->surface)); !written) return written;
  result->seconds.insert(result->seconds.begin(), {"decode", decoded - start});
  result->seconds.emplace_back("write", Now() - reconstructed);
  result->seconds.emplace_back("total", Now() - start);
  if (!options.preview.empty()) {
    if (Status written = WritePreviews(options.preview, *photograph, result->surface); !written) return written;
  }
  for (const std::string& warning : result->warnings) context.Note("warning: " + warning);
  context.Output(ToJson(*result),
                 fmt::format("{}: {} points, {:.1f} % of the lit field, carrier {:.2f} px, stripe order from {}",
                             options.out.string(), result->surface.size(), 100 * result->coverage,
                             result->carrier_period_px, ToString(result->regions.front().source)));
  return {};
}

}  // namespace

void AddCommand_reconstruct(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "reconstruct", "Compute a coloured surface (PLY, mm) from one photograph",
                 "striae reconstruct DSC_0001.JPG --calibration small.json --out limb.ply --preview pictures");
  auto options = std::make_shared<Options>();
  command->add_option("image", options->image, "Photograph: JPEG, PNG, TIFF or BMP")->required();
  command->add_option("--calibration", options->calibration, "Calibration of the rig (JSON)")->required();
  command->add_option("--out", options->out, "Surface to write (PLY)")->required();
  command->add_option("--distance-mm", options->distance_mm, "Distance of the subject, if known better than the rig's")
      ->check(CLI::PositiveNumber);
  command->add_option("--preview", options->preview, "Folder for photo.png, depth.png and shaded.png");
  command->add_flag("--no-faces", options->no_faces, "Write points only");
  OnRun(command, context, [options](Context& run) { return Reconstruct(run, *options); });
}

}  // namespace striae::app
