// Bodies from files: OBJ, PLY and STL, with their colours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig {

/// Axes of a mesh file, for a body that faces the viewer.
enum class MeshAxes {
  kCamera,  ///< x right, y down, z away: the camera frame
  kYUp,     ///< x right, y up, z towards the viewer: most OBJ files
  kZUp      ///< x right, y away, z up: most CAD files
};

struct MeshFileOptions {
  double unit_mm = 1;  ///< of the file's unit
  MeshAxes axes = MeshAxes::kCamera;
  std::optional<double>
      albedo;  ///< linear, for the whole body; otherwise the file's colours, and 0.6 where it has none
  std::uintmax_t most_bytes = 1U << 30U;
  std::size_t most_triangles = 20'000'000;
};

/// The body in the camera's axes and mm, its origin the file's. OBJ: vertex colours, or diffuse colour or picture of
/// its MTL; PLY (ascii, binary) with vertex colours; STL (ascii, binary). Colours and pictures are taken as sRGB.
/// Facets that meet at less than 50 degrees are shaded as one smooth surface. kNotFound for an absent file or picture,
/// kBadFile for one that cannot be read, holds no triangle, or is too large; kUsage for an unknown ending or unit.
Result<TriangleMesh> ReadMesh(const std::filesystem::path& path, const MeshFileOptions& options);

}  // namespace striae::rig
