// The Open Asset Import Library behind one door: mesh files to triangles, normals and colours.
#pragma once

#include <filesystem>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig::detail {

/// In the file's own unit and axes. Errors as ReadMesh.
Result<TriangleMesh> ReadWithAssimp(const std::filesystem::path& path, std::size_t most_triangles);

}  // namespace striae::rig::detail
