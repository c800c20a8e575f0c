#include "dicom/body_site.h"

#include <array>
#include <cctype>

namespace striae::dicom {
namespace {

struct Row {
  const char* typed;
  const char* value;
  const char* meaning;
  const char* body_part;
  bool paired;
  bool recognizable;
};

// Values and terms as in PS3.16 annex L (body part examined to SNOMED CT).
constexpr std::array<Row, 31> kRows{{
    {"abdomen", "818981001", "Abdomen", "ABDOMEN", false, false},
    {"ankle", "70258002", "Ankle joint", "ANKLE", true, false},
    {"arm", "40983000", "Upper arm", "ARM", true, false},
    {"upper arm", "40983000", "Upper arm", "ARM", true, false},
    {"back", "77568009", "Back", "BACK", false, false},
    {"breast", "76752008", "Breast", "BREAST", true, false},
    {"buttock", "46862004", "Buttock", "BUTTOCK", true, false},
    {"calf", "53840002", "Calf of leg", "CALF", true, false},
    {"cheek", "60819002", "Cheek", "CHEEK", true, true},
    {"chest", "43799004", "Chest", "CHEST", false, false},
    {"elbow", "16953009", "Elbow joint", "ELBOW", true, false},
    {"face", "89545001", "Face", "FACE", false, true},
    {"finger", "7569003", "Finger", "FINGER", true, false},
    {"foot", "56459004", "Foot", "FOOT", true, false},
    {"forearm", "14975008", "Forearm", "FOREARM", true, false},
    {"hand", "85562004", "Hand", "HAND", true, false},
    {"head", "69536005", "Head", "HEAD", false, true},
    {"head and neck", "774007", "Head and Neck", "HEADNECK", false, true},
    {"heel", "76853006", "Heel", "FOOT", true, false},
    {"hip", "24136001", "Hip joint", "HIP", true, false},
    {"knee", "72696002", "Knee", "KNEE", true, false},
    {"leg", "30021000", "Lower leg", "LEG", true, false},
    {"lower leg", "30021000", "Lower leg", "LEG", true, false},
    {"neck", "45048000", "Neck", "NECK", false, true},
    {"nose", "45206002", "Nose", "NOSE", false, true},
    {"sacrum", "54735007", "Sacrum", "SSPINE", false, false},
    {"scalp", "41695006", "Scalp", "SCALP", false, true},
    {"shoulder", "16982005", "Shoulder", "SHOULDER", true, false},
    {"thigh", "68367000", "Thigh", "THIGH", true, false},
    {"toe", "29707007", "Toe", "TOE", true, false},
    {"wrist", "74670003", "Wrist joint", "WRIST", true, false},
}};

std::string Normalised(std::string_view typed) {
  std::string out;
  for (const char c : typed) {
    const auto byte = static_cast<unsigned char>(c);
    const bool blank = std::isspace(byte) != 0 || c == '-' || c == '_';
    if (!blank) {
      out.push_back(static_cast<char>(std::tolower(byte)));
    } else if (!out.empty() && out.back() != ' ') {
      out.push_back(' ');
    }
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace

std::optional<BodySite> FindBodySite(std::string_view typed) {
  const std::string wanted = Normalised(typed);
  for (const Row& row : kRows) {
    if (wanted == row.typed) {
      return BodySite{{"SCT", row.value, row.meaning}, row.body_part, row.paired, row.recognizable};
    }
  }
  return std::nullopt;
}

std::optional<BodySite> SiteOf(const Capture& capture) {
  const bool head = capture.role.kind == CaptureRole::Kind::kNeutral || capture.role.kind == CaptureRole::Kind::kPose;
  return FindBodySite(capture.body_site.empty() && head ? "head" : capture.body_site);
}

std::optional<Code> LateralityCode(Laterality laterality) {
  switch (laterality) {
    case Laterality::kLeft:
      return Code{"SCT", "7771000", "Left"};
    case Laterality::kRight:
      return Code{"SCT", "24028007", "Right"};
    case Laterality::kBilateral:
      return Code{"SCT", "51440002", "Right and left"};
    case Laterality::kUnspecified:
    case Laterality::kUnpaired:
      break;
  }
  return std::nullopt;
}

bool MayBeRecognizable(const Capture& capture) {
  if (capture.role.kind == CaptureRole::Kind::kNeutral || capture.role.kind == CaptureRole::Kind::kPose) return true;
  const auto site = SiteOf(capture);
  return !site || site->recognizable;
}

}  // namespace striae::dicom
