#include "core/study.h"

namespace striae {
namespace {
tl::unexpected<Error> Unknown(std::string_view text, const char* expected) {
  return Fail(ErrorCode::kUsage, "'" + std::string(text.substr(0, 40)) + "' is not known; use " + expected);
}
}  // namespace

std::string_view ToString(RigRange range) { return range == RigRange::kSmall ? "small" : "large"; }

Result<RigRange> ParseRigRange(std::string_view text) {
  if (text == "small") return RigRange::kSmall;
  if (text == "large") return RigRange::kLarge;
  return Unknown(text, "small (1 m) or large (2 m)");
}

std::string CaptureRole::ToString() const {
  switch (kind) {
    case Kind::kWound:
      return "wound:" + label;
    case Kind::kNeutral:
      return "neutral";
    case Kind::kPose:
      return "pose";
    case Kind::kUnassigned:
      break;
  }
  return "unassigned";
}

Result<CaptureRole> CaptureRole::Parse(std::string_view text) {
  constexpr std::string_view kWoundPrefix = "wound:";
  if (text == "neutral") return CaptureRole{Kind::kNeutral, {}};
  if (text == "pose") return CaptureRole{Kind::kPose, {}};
  if (text == "unassigned") return CaptureRole{};
  if (text.starts_with(kWoundPrefix) && text.size() > kWoundPrefix.size()) {
    return CaptureRole{Kind::kWound, std::string(text.substr(kWoundPrefix.size()))};
  }
  return Unknown(text, "wound:LABEL, neutral or pose");
}

std::string_view ToString(Laterality laterality) {
  switch (laterality) {
    case Laterality::kLeft:
      return "L";
    case Laterality::kRight:
      return "R";
    case Laterality::kBilateral:
      return "B";
    case Laterality::kUnpaired:
      return "U";
    case Laterality::kUnspecified:
      break;
  }
  return "";
}

Result<Laterality> ParseLaterality(std::string_view text) {
  for (const auto value : {Laterality::kUnspecified, Laterality::kLeft, Laterality::kRight, Laterality::kBilateral,
                           Laterality::kUnpaired}) {
    if (text == ToString(value)) return value;
  }
  return Unknown(text, "L, R, B (both) or U (unpaired)");
}

std::string_view ToString(PreflightItem::State state) {
  switch (state) {
    case PreflightItem::State::kOk:
      return "ok";
    case PreflightItem::State::kWarning:
      return "warning";
    case PreflightItem::State::kFailed:
      return "failed";
    case PreflightItem::State::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace striae
