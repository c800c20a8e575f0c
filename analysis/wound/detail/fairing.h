// CGAL's fairing across the wound: what bends least between the smoothed skin of the ring.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace striae::wound {

/// What a faired sheet stands above the smooth skin that gave its rim; a square grid, zero on the rim and beyond.
struct FairedSheet {
  double low = 0, step = 1;  ///< of both coordinates
  int nodes = 0;             ///< a side
  std::vector<double> above;

  [[nodiscard]] double At(double u, double v) const;
};

/// The ring is resampled on a square grid, where it has points, at the heights of `smooth`; the nodes that it encloses
/// are moved by Polygon_mesh_processing::fair with tangential continuity (Botsch & Sorkine, IEEE Trans Vis Comput
/// Graph 2008, 14:213), so that the sheet solves the bi-Laplacian of its own metric. Coordinates are divided by the
/// ring's radius. Nothing where the ring does not close, or fairing fails.
std::optional<FairedSheet> FairAcross(const std::vector<Eigen::Vector3d>& ring, const std::vector<double>& weights,
                                      const std::function<double(double, double)>& smooth);

}  // namespace striae::wound
