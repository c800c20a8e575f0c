#include "app/verification.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "acquire/metadata.h"
#include "app/io/files.h"
#include "app/io/photograph.h"
#include "core/ply.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {
namespace {

using nlohmann::json;
using reconstruct::BallCheck;

bool IsPly(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 3 && bytes[0] == 'p' && bytes[1] == 'l' && bytes[2] == 'y';
}

/// A surface says in its comments which calibration it was made with.
std::optional<Sha256> CalibrationOf(const Surface& surface) {
  constexpr std::string_view kName = "calibration sha256 ";
  for (const std::string& comment : surface.comments) {
    if (!comment.starts_with(kName)) continue;
    if (const auto sha256 = Sha256::Parse(comment.substr(kName.size()))) return *sha256;
  }
  return std::nullopt;
}

Status FromPhotograph(const std::vector<std::uint8_t>& bytes, const std::optional<CalibrationFile>& calibration,
                      CheckInput& input) {
  const auto photograph = DecodePhotograph(bytes);
  if (!photograph) return Fail(photograph.error());
  if (!calibration) {
    return Fail(ErrorCode::kUsage, "a photograph needs the rig's calibration; give --calibration cal.json");
  }
  reconstruct::ReconstructOptions settings;
  settings.faces = false;
  auto made = reconstruct::Reconstruct(*photograph, calibration->calibration, settings);
  if (!made) return Fail(made.error());
  // PNG and the like have no EXIF; that is no reason not to measure.
  if (const auto metadata = acquire::ReadMetadata(bytes)) input.body_serial = metadata->body_serial;
  input.calibration = calibration->sha256;
  input.surface = std::move(made->surface);
  return {};
}

json ToJson(const BallCheck& ball) {
  return {{"centre_mm", {ball.centre.x(), ball.centre.y(), ball.centre.z()}},
          {"diameter_mm", ball.diameter_mm},
          {"form_mm", ball.form_mm},
          {"size_mm", ball.size_error_mm},
          {"sd_mm", ball.sd_mm},
          {"cap_deg", ball.cap_deg},
          {"filled", ball.filled},
          {"points", ball.points},
          {"rejected", ball.rejected}};
}

Result<json> Measure(const Surface& surface, const CheckPlan& plan) {
  if (plan.kind == "ball") {
    const auto check = reconstruct::CheckBall(surface, plan.diameter_mm, plan.options);
    if (!check) return Fail(check.error());
    return ToJson(*check);
  }
  if (plan.kind == "distance") {
    const auto check = reconstruct::CheckDistance(surface, plan.diameter_mm, plan.distance_mm, plan.options);
    if (!check) return Fail(check.error());
    return json{{"distance_mm", check->distance_mm},
                {"spacing_mm", check->error_mm},
                {"balls", {ToJson(check->first), ToJson(check->second)}}};
  }
  const auto check = reconstruct::CheckPlane(surface, plan.options);
  if (!check) return Fail(check.error());
  return json{{"flatness_mm", check->flatness_mm},
              {"sd_mm", check->sd_mm},
              {"length_mm", check->length_mm},
              {"centre_mm", {check->point.x(), check->point.y(), check->point.z()}},
              {"normal", {check->normal.x(), check->normal.y(), check->normal.z()}},
              {"points", check->points},
              {"rejected", check->rejected}};
}

json Limits(const CheckPlan& plan, RigRange range) {
  const reconstruct::Tolerances t = reconstruct::DefaultTolerances(range);
  const auto limit = [&](double by_default) { return plan.tolerance_mm.value_or(by_default); };
  if (plan.kind == "plane") return {{"flatness", limit(t.flatness_mm)}};
  if (plan.kind == "distance") return {{"spacing", limit(t.spacing_mm)}};
  return {{"form", limit(t.form_mm)}, {"size", limit(t.size_mm)}};
}

}  // namespace

Result<CalibrationFile> ParseCalibrationFile(std::span<const std::uint8_t> bytes, const std::string& name) {
  auto calibration = CalibrationFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!calibration) return Fail(calibration.error(), name);
  return CalibrationFile{*std::move(calibration), HashOf(bytes)};
}

Result<CheckInput> ReadCheckInput(const std::filesystem::path& file,
                                  const std::optional<CalibrationFile>& calibration) {
  const auto bytes = ReadFile(file);
  if (!bytes) return Fail(bytes.error());
  CheckInput input;
  input.file = file.filename().string();
  input.sha256 = HashOf(*bytes);
  if (IsPly(*bytes)) {
    auto surface = DecodePly(*bytes);
    if (!surface) return Fail(surface.error(), file.string());
    input.surface = *std::move(surface);
    input.calibration = CalibrationOf(input.surface);
  } else if (Status made = FromPhotograph(*bytes, calibration, input); !made) {
    return Fail(made.error(), file.string());
  }
  return input;
}

Result<json> RunCheck(const std::vector<CheckInput>& inputs, const CheckPlan& plan) {
  json document = {{"check", plan.kind}, {"passed", true}, {"inputs", json::array()}, {"worst_mm", json::object()}};
  if (plan.diameter_mm > 0) document["calibrated_diameter_mm"] = plan.diameter_mm;
  if (plan.distance_mm > 0) document["calibrated_distance_mm"] = plan.distance_mm;
  std::optional<RigRange> range = plan.range;
  for (const CheckInput& input : inputs) {
    auto figures = Measure(input.surface, plan);
    if (!figures) return Fail(figures.error(), input.file);
    if (!range) {
      const json& centre = plan.kind == "distance" ? (*figures)["balls"][0]["centre_mm"] : (*figures)["centre_mm"];
      range = reconstruct::RangeAt(centre[2]);
    }
    json entry = *std::move(figures);
    entry["file"] = input.file;
    entry["sha256"] = input.sha256.ToString();
    entry["calibration_sha256"] = input.calibration ? json(input.calibration->ToString()) : json();
    bool passed = true;
    const json limits = Limits(plan, *range);
    for (const auto& [name, limit] : limits.items()) {
      const double value = entry[name + "_mm"];
      passed = passed && std::abs(value) <= limit.get<double>();
      json& worst = document["worst_mm"][name];
      if (worst.is_null() || std::abs(value) > std::abs(worst.get<double>())) worst = value;
    }
    entry["passed"] = passed;
    document["passed"] = document["passed"].get<bool>() && passed;
    document["inputs"].push_back(std::move(entry));
    document["tolerances_mm"] = limits;
  }
  document["range"] = range ? std::string(ToString(*range)) : "";
  return document;
}

std::string CheckText(const json& document) {
  std::string text;
  const json& limits = document.at("tolerances_mm");
  for (const json& input : document.at("inputs")) {
    text += input.at("file").get<std::string>() + ":";
    for (const auto& [name, limit] : limits.items()) {
      text += fmt::format(" {} {:.3f} mm (tolerance {:g}),", name, input.at(name + "_mm").get<double>(),
                          limit.get<double>());
    }
    if (input.contains("sd_mm")) {
      text += fmt::format(" sd {:.3f} mm over all {} points,", input.at("sd_mm").get<double>(),
                          input.at("points").get<std::size_t>());
    }
    text += input.at("passed").get<bool>() ? " passed\n" : " FAILED\n";
  }
  text += document.at("check").get<std::string>() + " check of the " + document.at("range").get<std::string>() +
          " range: " + (document.at("passed").get<bool>() ? "passed" : "FAILED");
  return text;
}

}  // namespace striae::app
