#include "reconstruct/calibrate/steps.h"

#include <charconv>
#include <cmath>

namespace striae::reconstruct {
namespace {

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

Result<std::vector<CalibrationStep>> ParseSteps(std::string_view csv) {
  std::vector<CalibrationStep> steps;
  const auto bad = [](int line, const std::string& what) {
    return Fail(ErrorCode::kBadFile, "line " + std::to_string(line) + " of the steps: " + what);
  };
  if (csv.starts_with("\xef\xbb\xbf")) csv.remove_prefix(3);  // spreadsheets put a byte order mark before UTF-8
  int number = 0;
  while (!csv.empty()) {
    const auto end = csv.find('\n');
    const std::string_view line = Trimmed(csv.substr(0, end));
    csv = end == std::string_view::npos ? std::string_view() : csv.substr(end + 1);
    ++number;
    if (number == 1) {
      if (line != "image,position_mm") return bad(1, "the header must be image,position_mm");
      continue;
    }
    if (line.empty()) continue;
    const auto comma = line.rfind(',');
    if (comma == std::string_view::npos) return bad(number, "expected image,position_mm");
    CalibrationStep step{std::string(Trimmed(line.substr(0, comma))), 0};
    const std::string_view position = Trimmed(line.substr(comma + 1));
    const auto [rest, code] = std::from_chars(position.data(), position.data() + position.size(), step.position_mm);
    if (code != std::errc{} || rest != position.data() + position.size() || !std::isfinite(step.position_mm)) {
      return bad(number, "'" + std::string(position) + "' is no position in mm");
    }
    for (const CalibrationStep& other : steps) {
      if (other.image == step.image) return bad(number, step.image + " stands there twice");
      if (other.position_mm == step.position_mm) return bad(number, "two photographs at the same position");
    }
    steps.push_back(std::move(step));
  }
  if (steps.empty()) return bad(number, "no photograph is listed");
  return steps;
}

}  // namespace striae::reconstruct
