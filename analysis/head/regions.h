// What counts as head and as torso on the neutral photograph: as found, or as an operator drew it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/hex.h"
#include "core/result.h"

namespace striae::head {

/// Polygons in the neutral capture's sensor pixels (integer = pixel centre), as outlines of wounds are. An empty one
/// leaves that part to the program.
struct Regions {
  std::vector<Eigen::Vector2d> head_px, torso_px;
  /// Landmarks for absolute angles: between the brows, and the chin's foremost point.
  std::optional<Eigen::Vector2d> brow_px, chin_px;
  std::optional<Sha256> image_sha256;  ///< the photograph they were drawn on
};

/// Reads {"head_px": [[col,row],...], "torso_px": [...], "brow_px": [col,row], "chin_px": [col,row],
/// "image_sha256": "..."}; each is optional, but one polygon or both landmarks must be there. kBadFile with the reason:
/// not JSON, fewer than three points, not finite, self-crossing.
Result<Regions> RegionsFromJson(std::string_view text);
std::string ToJsonText(const Regions& regions);

}  // namespace striae::head
