#include "app/reconstructing.h"

#include <chrono>
#include <iterator>

#include <fmt/format.h>

#include "app/io/files.h"
#include "core/provenance.h"
#include "core/surface_comments.h"
#include "reconstruct/order.h"

namespace striae::app {
namespace {

nlohmann::json ToJson(const reconstruct::ReconstructionReport& r, const SurfaceSize& size) {
  nlohmann::json document = {{"points", size.points},
                             {"faces", size.faces},
                             {"coverage", r.coverage},
                             {"carrier_period_px", r.carrier_period_px},
                             {"local_period_px", {r.local_periods.fifth_px, r.local_periods.ninety_fifth_px}},
                             {"direction", ToString(r.direction)},
                             {"regions", nlohmann::json::array()},
                             {"warnings", r.warnings},
                             {"seconds", nlohmann::json::object()}};
  for (const auto& region : reconstruct::SummarisedRegions(r.regions)) {
    nlohmann::json entry = {
        {"points", region.points}, {"order_source", ToString(region.source)}, {"order_margin", region.margin}};
    if (!region.warning.empty()) entry["warning"] = region.warning;
    if (region.regions > 1) entry["regions"] = region.regions;
    document["regions"].push_back(entry);
  }
  if (r.target) {
    document["label"] = {{"marker_id", r.target->marker_id},
                         {"distance_mm", r.target->middle_mm.z()},
                         {"distance_uncertainty_mm", r.target->distance_sd_mm}};
  }
  if (r.of_calibration) {
    document["calibration_uncertainty_mm"] = {{"median", r.of_calibration->median_mm},
                                              {"largest", r.of_calibration->largest_mm}};
  }
  for (const auto& [stage, seconds] : r.seconds) document["seconds"][stage] = seconds;
  return document;
}

}  // namespace

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Result<Calibration> ReadCalibration(const std::filesystem::path& path, Sha256& sha256) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  sha256 = HashOf(*bytes);
  auto calibration = CalibrationFromJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!calibration) return Fail(calibration.error(), path.string());
  return calibration;
}

void SayWhatItIsMadeOf(const Sha256& photograph, const Sha256& calibration, std::vector<std::string>& comments) {
  const std::string lines[] = {"striae " + std::string(StriaeVersion()), PhotographComment(photograph),
                               "calibration sha256 " + calibration.ToString()};
  comments.insert(comments.begin(), std::begin(lines), std::end(lines));
}

void Announce(Context& context, const reconstruct::ReconstructionReport& result, const SurfaceSize& size,
              const nlohmann::json& more, const std::filesystem::path& out) {
  for (const std::string& warning : result.warnings) context.Note("warning: " + warning);
  nlohmann::json document = ToJson(result, size);
  document.update(more);
  context.Output(document,
                 fmt::format("{}: {} points, {:.1f} % of the lit field, carrier {:.2f} px, stripe order from {}",
                             out.string(), size.points, 100 * result.coverage, result.carrier_period_px,
                             ToString(result.regions.front().source)));
}

}  // namespace striae::app
