#include "reconstruct/decimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
namespace collapse = CGAL::Surface_mesh_simplification;

/// Stops at a number of faces: CGAL 5.5 counts edges alone.
class FacesLeft {
 public:
  explicit FacesLeft(std::size_t faces) : faces_(faces) {}
  template <typename Cost, typename Profile, typename Count>
  bool operator()(const Cost& /*cost*/, const Profile& profile, Count /*initial_edges*/, Count /*edges*/) const {
    return profile.surface_mesh().number_of_faces() <= faces_;
  }

 private:
  std::size_t faces_;
};

/// Points without a face are left out; a face that would make the mesh no manifold is left out too.
Mesh MeshOf(const Surface& surface) {
  Mesh mesh;
  mesh.reserve(static_cast<Mesh::size_type>(surface.size()), static_cast<Mesh::size_type>(surface.faces.size() * 3 / 2),
               static_cast<Mesh::size_type>(surface.faces.size()));
  std::vector<Mesh::Vertex_index> vertex(surface.size());
  for (const auto& face : surface.faces) {
    std::array<Mesh::Vertex_index, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      Mesh::Vertex_index& at = vertex[face[k]];
      if (!at.is_valid()) {
        const Eigen::Vector3d p = surface.point_in_camera[face[k]].cast<double>();
        at = mesh.add_vertex(Point(p.x(), p.y(), p.z()));
      }
      corners[k] = at;
    }
    mesh.add_face(corners[0], corners[1], corners[2]);
  }
  return mesh;
}

/// The input's points by their pixel, for looking up what lies nearest to a new point.
class NearestPixel {
 public:
  explicit NearestPixel(const Surface& surface) : surface_(surface), grid_(VertexIndexGrid(surface)) {}

  /// Index of the input's point nearest to `point` among those around `hint` (a point of the input close by).
  [[nodiscard]] std::size_t Find(const Eigen::Vector3f& point, std::size_t hint) const {
    std::size_t best = hint;
    for (bool moved = true; moved;) {  // downhill over the pixels
      moved = false;
      const int col = surface_.col[best], row = surface_.row[best];
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
          if (!grid_.Contains(col + dx, row + dy) || grid_(col + dx, row + dy) < 0) continue;
          const auto other = static_cast<std::size_t>(grid_(col + dx, row + dy));
          if (Squared(point, other) < Squared(point, best)) {
            best = other;
            moved = true;
          }
        }
      }
    }
    return best;
  }

 private:
  [[nodiscard]] float Squared(const Eigen::Vector3f& point, std::size_t index) const {
    return (surface_.point_in_camera[index] - point).squaredNorm();
  }
  const Surface& surface_;
  Image<std::int32_t> grid_;
};

/// Collapsing moves vertices but keeps their numbers: each started as a point of the input, the hint of where to look.
Surface SurfaceOf(const Mesh& mesh, const std::vector<std::uint32_t>& started_at, const Surface& input) {
  Surface out;
  out.sensor_width_px = input.sensor_width_px;
  out.sensor_height_px = input.sensor_height_px;
  out.comments = input.comments;
  const bool gridded = input.HasGrid();
  const NearestPixel nearest(input);
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), 0);
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    const Eigen::Vector3f point(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    std::size_t from = started_at[v.idx()];
    if (gridded) from = nearest.Find(point, from);
    number[v.idx()] = static_cast<std::uint32_t>(out.size());
    out.point_in_camera.push_back(point);
    out.colour.push_back(input.colour[from]);
    out.quality.push_back(input.quality[from]);
    if (!input.uncertainty_mm.empty()) out.uncertainty_mm.push_back(input.uncertainty_mm[from]);
    if (!gridded) continue;
    out.col.push_back(input.col[from]);
    out.row.push_back(input.row[from]);
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    std::array<std::uint32_t, 3> face{};
    std::size_t k = 0;
    for (const Mesh::Vertex_index v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) face[k++] = number[v.idx()];
    out.faces.push_back(face);
  }
  return out;
}

/// Which point of the input each vertex of MeshOf() is.
std::vector<std::uint32_t> StartedAt(const Surface& surface) {
  std::vector<std::uint32_t> started;
  std::vector<bool> seen(surface.size(), false);
  for (const auto& face : surface.faces) {
    for (const std::uint32_t corner : face) {
      if (!seen[corner]) started.push_back(corner);
      seen[corner] = true;
    }
  }
  return started;
}

std::vector<bool> WithFace(const Surface& surface) {
  std::vector<bool> has(surface.size(), false);
  for (const auto& face : surface.faces) {
    for (const std::uint32_t corner : face) has[corner] = true;
  }
  return has;
}

}  // namespace

Result<Surface> Decimate(const Surface& surface, std::size_t faces) {
  constexpr std::size_t kFewest = 4;
  if (faces < kFewest) return Fail(ErrorCode::kUsage, "a surface cannot be decimated to fewer than 4 faces");
  if (surface.faces.empty()) return Fail(ErrorCode::kMeasurementRefused, "the surface has no faces to decimate");
  if (surface.faces.size() <= faces) return surface;
  try {
    Mesh mesh = MeshOf(surface);
    using Policies = collapse::GarlandHeckbert_plane_policies<Mesh, Kernel>;
    const Policies policies(mesh);
    const collapse::Bounded_normal_change_filter<> filter;
    collapse::edge_collapse(
        mesh, FacesLeft(faces),
        CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()).filter(filter));
    return SurfaceOf(mesh, StartedAt(surface), surface);
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kInternal, std::string("CGAL could not decimate the surface: ") + e.what());
  }
}

Result<Deviation> DeviationFrom(const Surface& full, const Surface& decimated) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  if (decimated.faces.empty()) return Fail(ErrorCode::kMeasurementRefused, "the decimated surface has no faces");
  try {
    const Mesh mesh = MeshOf(decimated);
    Tree tree(mesh.faces().begin(), mesh.faces().end(), mesh);
    tree.build();
    tree.do_not_accelerate_distance_queries();  // neighbours ask one after the other: the last answer is the best hint
    const std::vector<bool> has_face = WithFace(full);
    constexpr int kBlock = 4096;
    const int blocks = static_cast<int>((full.size() + kBlock - 1) / kBlock);
    std::vector<Deviation> worst(static_cast<std::size_t>(blocks));  // rms_mm holds a sum of squares here
    std::vector<std::size_t> counts(worst.size(), 0);
    detail::ParallelLines(blocks, [&](int block) {
      const std::size_t first = static_cast<std::size_t>(block) * kBlock, last = std::min(full.size(), first + kBlock);
      Deviation& here = worst[static_cast<std::size_t>(block)];
      Point hint = mesh.point(*mesh.vertices().begin());
      for (std::size_t i = first; i < last; ++i) {
        if (!has_face[i]) continue;
        const Eigen::Vector3d p = full.point_in_camera[i].cast<double>();
        const Point point(p.x(), p.y(), p.z());
        hint = tree.closest_point(point, hint);
        const double squared = CGAL::squared_distance(point, hint);
        here.largest_mm = std::max(here.largest_mm, std::sqrt(squared));
        here.rms_mm += squared;
        ++counts[static_cast<std::size_t>(block)];
      }
    });
    Deviation all;
    std::size_t count = 0;
    for (std::size_t i = 0; i < worst.size(); ++i) {
      all.largest_mm = std::max(all.largest_mm, worst[i].largest_mm);
      all.rms_mm += worst[i].rms_mm;
      count += counts[i];
    }
    all.rms_mm = std::sqrt(all.rms_mm / static_cast<double>(std::max<std::size_t>(1, count)));
    return all;
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kInternal, std::string("CGAL could not measure the deviation: ") + e.what());
  }
}

}  // namespace striae::reconstruct
