// Pictures of one wound: the photograph with the boundary, the depth map on a fixed scale, a view of the shaded surface
// under its virtual skin, and two sections.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/wound/wound.h"
#include "core/image.h"
#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

/// Writes boundary.png, depth.png (0 to 15 mm, whatever the wound: pictures of visits can be laid side by side),
/// view.png and sections.svg into `folder`, which is made; the same input gives the same bytes. Returns their paths.
Result<std::vector<std::string>> WriteWoundPictures(const std::filesystem::path& folder, const Surface& surface,
                                                    const Outline& outline, const wound::WoundMaps& maps);

/// Reads the photograph that a surface was made from. kUsage where it is another.
Result<ImageRgb> PhotographOfSurface(const std::filesystem::path& path, const Surface& surface);

/// What lies within 12 mm of the outline on the photograph itself, with the line; pixels of `pixel_mm`.
ImageRgb OutlineOnPhotograph(const ImageRgb& photograph, const Outline& outline, double pixel_mm);

}  // namespace striae::app
