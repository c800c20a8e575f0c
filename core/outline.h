// A wound's boundary as the operator drew it, in sensor pixels (integer = pixel centre), and its JSON forms.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/hex.h"
#include "core/result.h"

namespace striae {

struct Outline {
  std::vector<Eigen::Vector2d> polygon_px;  ///< (col, row), not repeated at the end
  std::optional<Sha256> image_sha256;       ///< the photograph it was drawn on
};

/// Reads {"polygon_px": [[col,row],...]} or a LabelMe file with one polygon (its convention has the pixel's corner at
/// integers: 0.5 px are subtracted). kBadFile with the reason: fewer than three points, not finite, several polygons,
/// self-crossing.
Result<Outline> OutlineFromJson(std::string_view text);
std::string ToJsonText(const Outline& outline);

/// True if two sides that are not neighbours meet.
bool SelfCrossing(const std::vector<Eigen::Vector2d>& polygon);
/// Even-odd rule; points exactly on a side may fall either way.
bool Inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point);

}  // namespace striae
