// The vocabulary of a longitudinal study. Plain values; who keeps them is store/. No name of a person stands here:
// a subject is a pseudonym only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/hex.h"
#include "core/id.h"
#include "core/result.h"
#include "core/time.h"

namespace striae {

struct Study {
  StudyId id;
  std::string protocol;  ///< the sponsor's protocol number
  std::string title;
  std::string sponsor;
  std::string coordinating_centre;
  std::string subject_pattern;  ///< of pseudonyms, e.g. "S###C"; empty: any (docs/record.md)
  std::string check_digit;      ///< "iso7064", "luhn", "verhoeff"; empty when the pattern has none
};

struct Site {
  SiteId id;
  std::string code;  ///< short, unique in the study
  std::string name;
  std::string time_zone;  ///< IANA name, e.g. Europe/Ljubljana; empty if not known
};

struct Subject {
  SubjectId id;
  std::string pseudonym;  ///< e.g. "S001"
  SiteId site;
  std::optional<Date> consent_given;
  std::optional<Date> consent_withdrawn;
  [[nodiscard]] bool HasActiveConsent() const { return consent_given.has_value() && !consent_withdrawn.has_value(); }
};

struct Visit {
  VisitId id;
  SubjectId subject;
  std::string name;  ///< e.g. "V1"
};

/// Which of the rig's two gratings and distances (OPTICS: small = 1 m, large = 2 m).
enum class RigRange { kSmall, kLarge };
std::string_view ToString(RigRange range);
Result<RigRange> ParseRigRange(std::string_view text);

/// One apparatus: a camera body with its lens and grating projector.
struct Device {
  DeviceId id;
  std::string serial;  ///< of the camera body, as EXIF has it
  RigRange range = RigRange::kSmall;
  std::string model;  ///< "NIKON D90"
  std::string lens;
};

/// A calibration file in force for a device from a day on; the newest valid one is used.
struct CalibrationReference {
  CalibrationId id;
  DeviceId device;
  Sha256 sha256;  ///< of the calibration file in objects/
  Date valid_from;
};

struct Session {
  SessionId id;
  SubjectId subject;
  VisitId visit;
  std::string operator_name;  ///< the user who logged it, as known to the record
  UtcTime opened_at;
  std::optional<UtcTime> closed_at;
  std::string site_time_zone;
  std::optional<int> camera_clock_offset_s;  ///< camera clock minus UTC, measured
  std::optional<Date> day;                   ///< at the site, in its zone; none: the UTC day of opened_at
};

/// What a photograph is for: a wound with its label, the head's neutral pose, another pose, or not said.
struct CaptureRole {
  enum class Kind { kUnassigned, kWound, kNeutral, kPose };
  Kind kind = Kind::kUnassigned;
  std::string label;  ///< the wound's label ("W1"); empty otherwise
  /// "wound:W1", "neutral", "pose", "unassigned"
  [[nodiscard]] std::string ToString() const;
  static Result<CaptureRole> Parse(std::string_view text);
  bool operator==(const CaptureRole&) const = default;
};

enum class Laterality { kUnspecified, kLeft, kRight, kBilateral, kUnpaired };
/// "", "L", "R", "B", "U" as DICOM (0020,0062) has them.
std::string_view ToString(Laterality laterality);
Result<Laterality> ParseLaterality(std::string_view text);

/// What the camera wrote into the file. Unknown values are empty. Times are the camera's own clock, without a zone.
struct PhotoMetadata {
  std::string make, model, body_serial, lens;
  std::optional<double> exposure_s, f_number, focal_length_mm, focus_distance_m;
  std::optional<int> iso, orientation, shutter_count;
  std::optional<bool> flash_fired;
  std::string taken_at_camera_clock;  ///< "2026:05:04 07:08:09.12", raw
  std::string quality, focus_mode, white_balance, user_comment;
  int width_px = 0, height_px = 0;  ///< of the stored pixels, before any Orientation
};

/// One line of the preflight verdict on a photograph.
struct PreflightItem {
  enum class State { kOk, kWarning, kFailed, kUnknown };
  std::string name;  ///< "exposure time"
  State state = State::kUnknown;
  std::string found, expected;
  std::string advice;  ///< what to do; empty when ok
};
std::string_view ToString(PreflightItem::State state);

struct Capture {
  CaptureId id;
  SessionId session;
  Sha256 sha256;  ///< of the original bytes
  std::string file_name;
  std::string media_type;  ///< "image/jpeg", "image/x-nikon-nef", ...
  std::uint64_t size_bytes = 0;
  CaptureRole role;
  std::string body_site;  ///< "calf"; free text, coded at export
  Laterality laterality = Laterality::kUnspecified;
  UtcTime imported_at;
  PhotoMetadata metadata;
  std::vector<PreflightItem> preflight;
};

}  // namespace striae
