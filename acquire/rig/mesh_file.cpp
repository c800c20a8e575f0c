#include "acquire/rig/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "acquire/rig/detail/assimp_mesh.h"

namespace striae::rig {
namespace {

constexpr double kSmallest_mm = 1, kLargest_mm = 20000;  // of a body before a camera at 0.1 to 10 m

Eigen::Matrix3d CameraFromAxes(MeshAxes axes) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (axes == MeshAxes::kYUp) turn << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  if (axes == MeshAxes::kZUp) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

Status CheckSize(const TriangleMesh& mesh, const std::string& name) {
  Eigen::Vector3d low = mesh.vertex.front(), high = low;
  for (const Eigen::Vector3d& v : mesh.vertex) {
    if (!v.allFinite())
      return Fail(ErrorCode::kBadFile, name + " has coordinates that are not finite; export it again");
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const double size = (high - low).maxCoeff();
  if (size >= kSmallest_mm && size <= kLargest_mm) return {};
  return Fail(ErrorCode::kUsage,
              fmt::format("{} is {:g} mm large; say the file's unit (1 for mm, 10 for cm, 1000 for m)", name, size));
}

/// What the library would search without end or trust without reason: a PLY without the end of its header, and a binary
/// STL that is shorter than its count of facets says.
Status CheckStart(const std::filesystem::path& path, const std::string& ending, std::uintmax_t bytes) {
  std::string start(std::min<std::uintmax_t>(bytes, 65536), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  const Status broken = Fail(ErrorCode::kBadFile, path.string() + " is cut off or no mesh; export it again");
  if (!file) return broken;
  if (ending == ".ply" && (start.rfind("ply", 0) != 0 || start.find("end_header") == std::string::npos)) return broken;
  if (ending == ".stl" && start.rfind("solid", 0) != 0) {
    if (start.size() < 84) return broken;
    std::uint32_t facets = 0;
    for (std::size_t i = 4; i-- > 0;) facets = facets << 8U | static_cast<unsigned char>(start[80 + i]);
    if (bytes < 84 + 50 * static_cast<std::uintmax_t>(facets)) return broken;
  }
  return {};
}

}  // namespace

Result<TriangleMesh> ReadMesh(const std::filesystem::path& path, const MeshFileOptions& options) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending != ".obj" && ending != ".ply" && ending != ".stl") {
    return Fail(ErrorCode::kUsage, path.string() + " is no mesh that can be read; convert it to OBJ, PLY or STL");
  }
  if (!(options.unit_mm > 0) || !std::isfinite(options.unit_mm) ||
      (options.albedo && !(*options.albedo >= 0 && *options.albedo <= 1))) {
    return Fail(ErrorCode::kUsage, "a mesh's unit must be positive and an albedo lie between 0 and 1");
  }
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) return Fail(ErrorCode::kNotFound, "cannot open " + path.string() + ": " + error.message());
  if (bytes > options.most_bytes) {
    return Fail(ErrorCode::kBadFile, fmt::format("{} has {} MB, more than {} MB; decimate it", path.string(),
                                                 bytes >> 20U, options.most_bytes >> 20U));
  }
  if (Status whole = CheckStart(path, ending, bytes); !whole) return Fail(whole.error());
  auto mesh = detail::ReadWithAssimp(path, options.most_triangles);
  if (!mesh) return Fail(mesh.error());
  if (options.albedo) {
    mesh->albedo.assign(mesh->vertex.size(), Eigen::Vector3f::Constant(static_cast<float>(*options.albedo)));
    mesh->texture_of_triangle.clear();
  }
  for (Eigen::Vector3d& v : mesh->vertex) v *= options.unit_mm;
  if (Status sized = CheckSize(*mesh, path.string()); !sized) return Fail(sized.error());
  Move(CameraFromAxes(options.axes), Eigen::Vector3d::Zero(), *mesh);
  return mesh;
}

}  // namespace striae::rig
