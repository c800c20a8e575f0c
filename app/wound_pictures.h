// Pictures of one wound: the photograph with the boundary, the depth map on a fixed scale, a view of the shaded surface
// under its virtual skin, and two sections.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/wound/wound.h"
#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

/// Writes boundary.png, depth.png (0 to 15 mm, whatever the wound: pictures of visits can be laid side by side),
/// view.png and sections.svg into `folder`, which is made; the same input gives the same bytes. Returns their paths.
Result<std::vector<std::string>> WriteWoundPictures(const std::filesystem::path& folder, const Surface& surface,
                                                    const Outline& outline, const wound::WoundMaps& maps);

}  // namespace striae::app
