#define CGAL_EIGEN3_ENABLED 1  // CGAL's switch for its sparse solver

#include "analysis/wound/detail/fairing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Surface_mesh.h>

namespace striae::wound {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;

constexpr double kStep = 0.08;   // of the ring's radius: some 300 nodes across the wound
constexpr int kLeastPoints = 2;  // of the ring at a node that belongs to it

enum class Node : std::uint8_t { kWound, kRing, kOutside };

struct Grid {
  FairedSheet sheet;
  std::vector<Node> node;
  [[nodiscard]] std::size_t At(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(sheet.nodes) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] double Coordinate(int i) const { return sheet.low + i * sheet.step; }
};

Grid MarkRing(const std::vector<Eigen::Vector3d>& ring, const std::vector<double>& weights) {
  double most = 0;
  for (const auto& p : ring) most = std::max(most, p.head<2>().cwiseAbs().maxCoeff());
  Grid grid;
  const int half = static_cast<int>(std::ceil(most / kStep)) + 2;  // an empty frame all around
  grid.sheet.low = -half * kStep;
  grid.sheet.step = kStep;
  grid.sheet.nodes = 2 * half + 1;
  const auto count = static_cast<std::size_t>(grid.sheet.nodes) * static_cast<std::size_t>(grid.sheet.nodes);
  grid.sheet.above.assign(count, 0);
  std::vector<int> points(count, 0);
  for (std::size_t k = 0; k < ring.size(); ++k) {
    if (weights[k] <= 0) continue;
    const int i = static_cast<int>(std::lround(ring[k].x() / kStep)) + half,
              j = static_cast<int>(std::lround(ring[k].y() / kStep)) + half;
    ++points[grid.At(i, j)];
  }
  grid.node.assign(count, Node::kWound);
  for (std::size_t k = 0; k < count; ++k) {
    if (points[k] >= kLeastPoints) grid.node[k] = Node::kRing;
  }
  return grid;
}

// What is reached from the frame without crossing the ring is outside; corners count as passages, so that a node of
// the wound never lies at the mesh's border.
void MarkOutside(Grid& grid) {
  std::vector<std::pair<int, int>> reached = {{0, 0}};
  grid.node[0] = Node::kOutside;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const auto [i, j] = reached[k];
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const int a = i + di, b = j + dj;
        if (a < 0 || b < 0 || a >= grid.sheet.nodes || b >= grid.sheet.nodes) continue;
        auto& node = grid.node[grid.At(a, b)];
        if (node != Node::kWound) continue;
        node = Node::kOutside;
        reached.emplace_back(a, b);
      }
    }
  }
}

struct Sheet {
  Mesh mesh;
  std::vector<Vertex> vertex;  ///< of each node; null outside
  std::vector<Vertex> free;    ///< those of the wound
};

Sheet Triangulate(const Grid& grid, const std::function<double(double, double)>& smooth) {
  Sheet sheet;
  const int n = grid.sheet.nodes;
  sheet.vertex.assign(grid.node.size(), Mesh::null_vertex());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::size_t k = grid.At(i, j);
      if (grid.node[k] == Node::kOutside) continue;
      const double u = grid.Coordinate(i), v = grid.Coordinate(j);
      sheet.vertex[k] = sheet.mesh.add_vertex({u, v, smooth(u, v)});
      if (grid.node[k] == Node::kWound) sheet.free.push_back(sheet.vertex[k]);
    }
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const Vertex a = sheet.vertex[grid.At(i, j)], b = sheet.vertex[grid.At(i + 1, j)],
                   c = sheet.vertex[grid.At(i, j + 1)], d = sheet.vertex[grid.At(i + 1, j + 1)];
      const Vertex none = Mesh::null_vertex();
      if (a == none || b == none || c == none || d == none) continue;
      sheet.mesh.add_face(a, b, d);
      sheet.mesh.add_face(a, d, c);
    }
  }
  return sheet;
}

}  // namespace

double FairedSheet::At(double u, double v) const {
  const double x = (u - low) / step, y = (v - low) / step;
  if (!(x >= 0 && y >= 0 && x < nodes - 1 && y < nodes - 1)) return 0;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double a = x - i, b = y - j;
  const auto node = [&](int col, int row) {
    return above[static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes) + static_cast<std::size_t>(col)];
  };
  return (1 - b) * ((1 - a) * node(i, j) + a * node(i + 1, j)) +
         b * ((1 - a) * node(i, j + 1) + a * node(i + 1, j + 1));
}

std::optional<FairedSheet> FairAcross(const std::vector<Eigen::Vector3d>& ring, const std::vector<double>& weights,
                                      const std::function<double(double, double)>& smooth) {
  Grid grid = MarkRing(ring, weights);
  MarkOutside(grid);
  try {
    Sheet sheet = Triangulate(grid, smooth);
    if (sheet.free.empty() || !CGAL::Polygon_mesh_processing::fair(sheet.mesh, sheet.free)) return std::nullopt;
    for (int j = 0; j < grid.sheet.nodes; ++j) {
      for (int i = 0; i < grid.sheet.nodes; ++i) {
        const std::size_t k = grid.At(i, j);
        if (grid.node[k] != Node::kWound) continue;
        const auto& p = sheet.mesh.point(sheet.vertex[k]);
        if (!std::isfinite(p.z())) return std::nullopt;
        // Fairing moves a node along the sheet too: what it stands above the smooth skin is taken where it now is.
        grid.sheet.above[k] = p.z() - smooth(p.x(), p.y());
      }
    }
  } catch (const std::exception&) {  // a mesh that CGAL cannot work on is a ring that cannot be faired
    return std::nullopt;
  }
  return std::move(grid.sheet);
}

}  // namespace striae::wound
