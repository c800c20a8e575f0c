#include "analysis/wound/detail/closed_volume.h"

#include <map>
#include <string>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

namespace striae::wound {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::vector<Mesh::Vertex_index> AddPoints(Mesh& mesh, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Mesh::Vertex_index> vertices;
  vertices.reserve(points.size());
  for (const auto& p : points) vertices.push_back(mesh.add_vertex({p.x(), p.y(), p.z()}));
  return vertices;
}

Status Close(Mesh& mesh, const SheetPair& pair) {
  const auto bed = AddPoints(mesh, pair.bed), skin = AddPoints(mesh, pair.skin);
  const auto add = [&](Mesh::Vertex_index a, Mesh::Vertex_index b, Mesh::Vertex_index c) {
    return mesh.add_face(a, b, c) != Mesh::null_face();
  };
  for (const auto& [a, b, c] : pair.triangles) {
    // Outwards is up on the skin and down on the bed.
    if (!add(skin[a], skin[b], skin[c]) || !add(bed[a], bed[c], bed[b])) {
      return Fail(ErrorCode::kInternal, "the wound's triangulation is not manifold");
    }
  }
  // The side wall joins each rim edge of the skin with the bed's edge below it.
  const auto bed_offset = pair.bed.size();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rim;
  for (const auto h : mesh.halfedges()) {
    if (!mesh.is_border(h)) continue;
    const std::uint32_t from = static_cast<std::uint32_t>(mesh.source(h)),
                        to = static_cast<std::uint32_t>(mesh.target(h));
    if (from >= bed_offset) {
      rim.emplace_back(from - static_cast<std::uint32_t>(bed_offset), to - static_cast<std::uint32_t>(bed_offset));
    }
  }
  for (const auto& [from, to] : rim) {
    if (!add(skin[from], skin[to], bed[to]) || !add(skin[from], bed[to], bed[from])) {
      return Fail(ErrorCode::kInternal, "the side wall between skin and bed is not manifold");
    }
  }
  if (!CGAL::is_closed(mesh)) return Fail(ErrorCode::kInternal, "skin and bed do not close into one body");
  return {};
}

}  // namespace

Result<double> VolumeBetween(const SheetPair& pair) {
  try {
    Mesh mesh;
    const auto triangles = pair.triangles.size();
    mesh.reserve(static_cast<Mesh::size_type>(2 * pair.bed.size()), static_cast<Mesh::size_type>(3 * triangles),
                 static_cast<Mesh::size_type>(2 * triangles));
    if (auto closed = Close(mesh, pair); !closed) return Fail(closed.error());
    return CGAL::to_double(CGAL::Polygon_mesh_processing::volume(mesh));
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kInternal, std::string("CGAL could not take the wound's volume: ") + e.what());
  }
}

}  // namespace striae::wound
