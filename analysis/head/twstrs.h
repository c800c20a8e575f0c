// The severity bands of the Toronto Western Spasmodic Torticollis Rating Scale that have limits in degrees.
#pragma once

#include <optional>
#include <string>

namespace striae::head {

/// Score and words of a measured angle. Only the maximal excursions of rotation (0-4) and lateral tilt (0-3) have
/// limits in degrees; antero- and retrocollis have none and are not scored. It is what was measured in one pose, not a
/// rater's score.
struct Band {
  int score = 0;
  std::string words;  ///< "slight (1 to 22 deg), measured"
};

/// `name` is rotation or tilt; none for the others, and for angles beyond the scale's 90 degrees of rotation. Angles
/// are rounded to whole degrees first: the scale has no fractions.
std::optional<Band> TwstrsBand(const std::string& name, double degrees);

}  // namespace striae::head
