#include "acquire/preflight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace striae::acquire {
namespace {

using State = PreflightItem::State;

std::string Number(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g%s", value, unit);
  return text;
}

std::string Exposure(double seconds) {
  return seconds < 0.3 ? "1/" + Number(std::round(1 / seconds), " s") : Number(seconds, " s");
}

struct Expectation {
  std::string name, expected, advice;
  State otherwise;  ///< the state when the photograph differs
};

PreflightItem Judge(const Expectation& expectation, bool known, bool good, std::string found) {
  PreflightItem item;
  item.name = expectation.name;
  item.expected = expectation.expected;
  item.found = known ? std::move(found) : "not in the file";
  item.state = !known ? State::kUnknown : good ? State::kOk : expectation.otherwise;
  if (item.state != State::kOk) item.advice = expectation.advice;
  return item;
}

/// Equal on the scale of exposure steps: half of the camera's third of a stop.
bool SameStep(double value, double expected) { return std::abs(std::log2(value / expected)) < 1.0 / 6; }

PreflightItem Model(const PhotoMetadata& photo) {
  return Judge({"camera", "NIKON D90", "use the camera body that the rig was calibrated with", State::kFailed},
               !photo.model.empty(), photo.model == "NIKON D90", photo.model);
}

PreflightItem PictureSize(const PhotoMetadata& photo) {
  const bool good = photo.width_px == 4288 && photo.height_px == 2848;
  return Judge(
      {"picture size", "4288 x 2848", "set image size L, and do not edit, crop or turn the file", State::kFailed},
      photo.width_px > 0, good, std::to_string(photo.width_px) + " x " + std::to_string(photo.height_px));
}

PreflightItem Flash(const PhotoMetadata& photo) {
  return Judge({"flash", "fired", "open the flash and wait until it is charged: without it there are no stripes",
                State::kFailed},
               photo.flash_fired.has_value(), photo.flash_fired.value_or(false),
               photo.flash_fired.value_or(false) ? "fired" : "did not fire");
}

PreflightItem FocalLength(const PhotoMetadata& photo) {
  const double mm = photo.focal_length_mm.value_or(0);
  return Judge(
      {"focal length", "50 mm", "mount the rig's 50 mm lens: the calibration holds for it alone", State::kFailed},
      photo.focal_length_mm.has_value(), std::abs(mm - 50) <= 0.5, Number(mm, " mm"));
}

PreflightItem ExposureTime(const PhotoMetadata& photo) {
  const double seconds = photo.exposure_s.value_or(1);
  return Judge(
      {"exposure time", "1/200 s", "dial M, shutter 1/200 s: longer lets in room light and motion", State::kWarning},
      photo.exposure_s.has_value(), SameStep(seconds, 1.0 / 200), Exposure(seconds));
}

PreflightItem Aperture(const PhotoMetadata& photo) {
  const double number = photo.f_number.value_or(1);
  return Judge(
      {"aperture", "f/11", "dial M, aperture f/11: depth of field must cover the measuring range", State::kWarning},
      photo.f_number.has_value(), SameStep(number, 11), "f/" + Number(number, ""));
}

PreflightItem Iso(const PhotoMetadata& photo) {
  const int iso = photo.iso.value_or(0);
  return Judge({"ISO", "200-500", "set ISO 200 to 500 and turn ISO automatic off", State::kWarning},
               photo.iso.has_value(), iso >= 200 && iso <= 500, std::to_string(iso));
}

PreflightItem FocusMode(const PhotoMetadata& photo) {
  const bool manual = photo.focus_mode.rfind("MANUAL", 0) == 0 || photo.focus_mode == "MF";
  return Judge(
      {"focus mode", "MANUAL", "set manual focus: autofocus changes the calibrated image distance", State::kWarning},
      !photo.focus_mode.empty(), manual, photo.focus_mode);
}

PreflightItem FocusDistance(const PhotoMetadata& photo, RigRange range) {
  // The lens reports steps of 6 %; the middle 80 % of the working range plus one and a half steps on each side.
  const bool small = range == RigRange::kSmall;
  const double near_m = small ? 0.85 : 1.70, far_m = small ? 1.18 : 2.25;
  const double distance_m = photo.focus_distance_m.value_or(0);
  return Judge({"focus distance", small ? "about 1 m" : "about 2 m",
                "focus the lens at the mark of this rig's range and leave it there", State::kWarning},
               photo.focus_distance_m.has_value(), distance_m >= near_m && distance_m <= far_m,
               Number(std::round(100 * distance_m) / 100, " m"));
}

int Severity(State state) {
  switch (state) {
    case State::kOk:
      return 0;
    case State::kUnknown:
      return 1;
    case State::kWarning:
      return 2;
    case State::kFailed:
      return 3;
  }
  return 3;
}

}  // namespace

std::vector<PreflightItem> Preflight(const PhotoMetadata& photo, RigRange range) {
  return {Model(photo),    PictureSize(photo), Flash(photo),     FocalLength(photo),         ExposureTime(photo),
          Aperture(photo), Iso(photo),         FocusMode(photo), FocusDistance(photo, range)};
}

PreflightItem::State Verdict(const std::vector<PreflightItem>& items) {
  State worst = State::kOk;
  for (const auto& item : items) {
    if (Severity(item.state) > Severity(worst)) worst = item.state;
  }
  return worst;
}

}  // namespace striae::acquire
