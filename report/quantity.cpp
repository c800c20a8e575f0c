#include "report/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/format.h"

namespace striae::report {
namespace {

struct Known {
  std::string_view name, label;
  bool angle, headline;
};

// The order of the table.
constexpr std::array<Known, 14> kKnown = {{{"area", "Area", false, true},
                                           {"volume", "Volume", false, true},
                                           {"depth_mean", "Mean depth", false, false},
                                           {"depth_p95", "95th pct. of depth", false, false},
                                           {"depth_max", "Deepest point", false, false},
                                           {"length", "Length", false, false},
                                           {"width", "Width", false, false},
                                           {"perimeter", "Perimeter", false, false},
                                           {"bed_area", "Bed area", false, false},
                                           {"proud_volume", "Proud tissue volume", false, false},
                                           {"rotation", "Rotation", true, true},
                                           {"flexion", "Flexion", true, true},
                                           {"tilt", "Tilt", true, true},
                                           {"total_angle", "Total angle", true, false}}};

struct Phrase {
  std::string_view name, verb, positive, negative;
};

constexpr std::array<Phrase, 3> kPhrases = {
    {{"rotation", "turned", "to the subject's left", "to the subject's right"},
     {"flexion", "bent", "forward, chin towards chest", "back, chin away from chest"},
     {"tilt", "tilted", "to the subject's right", "to the subject's left"}}};

}  // namespace

Quantity DescribeQuantity(std::string_view name, HeadGoal goal) {
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.name == name; });
  if (known == kKnown.end()) {
    std::string label(name);
    std::replace(label.begin(), label.end(), '_', ' ');
    return {label, static_cast<int>(kKnown.size()), Better::kNotDefined, false};
  }
  Better better = Better::kSmaller;
  if (known->angle) better = goal == HeadGoal::kNearerNeutral ? Better::kSmallerSize : Better::kLargerSize;
  return {std::string(known->label), static_cast<int>(known - kKnown.begin()), better, known->headline};
}

std::string InWords(std::string_view name, double value, double uncertainty) {
  const auto* phrase = std::find_if(kPhrases.begin(), kPhrases.end(), [&](const Phrase& p) { return p.name == name; });
  if (phrase == kPhrases.end()) return {};
  if (std::abs(value) <= 1.96 * uncertainty || std::abs(value) < 0.5) return "straight within error";
  return std::string(phrase->verb) + " " + FormatNumber(std::abs(value), 0) + " deg " +
         std::string(value > 0 ? phrase->positive : phrase->negative);
}

}  // namespace striae::report
