#include "analysis/head/twstrs.h"

#include <array>
#include <cmath>
#include <span>

namespace striae::head {
namespace {

struct Limit {
  long most_deg;
  const char* words;
};
constexpr std::array<Limit, 5> kRotation{{{0, "none (0 deg)"},
                                          {22, "slight (1 to 22 deg)"},
                                          {45, "mild (23 to 45 deg)"},
                                          {67, "moderate (46 to 67 deg)"},
                                          {90, "severe (68 to 90 deg)"}}};
constexpr std::array<Limit, 4> kTilt{
    {{0, "none (0 deg)"}, {15, "mild (1 to 15 deg)"}, {35, "moderate (16 to 35 deg)"}, {180, "severe (over 35 deg)"}}};

std::optional<Band> Find(std::span<const Limit> limits, long degrees) {
  for (std::size_t score = 0; score < limits.size(); ++score) {
    if (degrees <= limits[score].most_deg) {
      return Band{static_cast<int>(score), std::string(limits[score].words) + ", measured"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Band> TwstrsBand(const std::string& name, double degrees) {
  if (!std::isfinite(degrees)) return std::nullopt;
  const long whole = std::lround(std::abs(degrees));
  if (name == "rotation") return Find(kRotation, whole);
  if (name == "tilt") return Find(kTilt, whole);
  return std::nullopt;
}

}  // namespace striae::head
