// A surface on the disk in the formats that other programs read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/io/ply_file.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

enum class SurfaceFormat { kPly, kStl, kObj };

/// By `name` ("ply", "stl", "obj") when not empty, else by the path's extension. kUsage for any other.
Result<SurfaceFormat> FormatOf(const std::filesystem::path& path, const std::string& name);

/// Writes the surface, an OBJ with its material (.mtl) and texture (.jpg) beside it; says which files. Nothing of them
/// stays when one cannot be written. kUsage for an STL or OBJ without faces.
Result<std::vector<std::filesystem::path>> WriteSurface(const Surface& surface, const std::filesystem::path& path,
                                                        SurfaceFormat format);

struct DecimatedSurface {
  Surface surface;
  double deviation_largest_mm = 0, deviation_rms_mm = 0;  ///< one-sided, from every point of the full surface
};
/// At most `faces` triangles: by sensor pixels down to eight times as many, by edge collapse from there.
Result<DecimatedSurface> DecimateForFile(const Surface& surface, std::size_t faces);

}  // namespace striae::app
