#include "analysis/wound/detail/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/QR>

namespace striae::wound {
namespace {

// Neighbouring cells further apart in range than this many cell sizes lie across an edge: a grazing angle of 79
// degrees.
constexpr double kJumpCells = 5;

Eigen::Matrix<double, 1, 10> CubicTerms(double x, double y) {
  Eigen::Matrix<double, 1, 10> t;
  t << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return t;
}

struct Box {
  int left, top, right, bottom;  // inclusive
};

Box BoundingBox(const std::vector<Eigen::Vector2d>& polygon, double margin_px, const Surface& surface) {
  Eigen::Vector2d low = polygon.front(), high = polygon.front();
  for (const auto& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto clamp = [](double value, int size) { return static_cast<int>(std::clamp(value, 0.0, size - 1.0)); };
  return {clamp(std::floor(low.x() - margin_px), surface.sensor_width_px),
          clamp(std::floor(low.y() - margin_px), surface.sensor_height_px),
          clamp(std::ceil(high.x() + margin_px), surface.sensor_width_px),
          clamp(std::ceil(high.y() + margin_px), surface.sensor_height_px)};
}

double MedianSpacing(const Surface& surface, const Image<std::int32_t>& grid, const Box& box) {
  std::vector<double> spacing;
  const int step = std::max(1, (box.right - box.left) / 100);
  for (int row = box.top; row <= box.bottom; row += step) {
    for (int col = box.left; col <= box.right; col += step) {
      const auto here = grid(col, row);
      if (here < 0) continue;
      for (const auto& [dc, dr] : {std::array{1, 0}, std::array{0, 1}}) {
        if (!grid.Contains(col + dc, row + dr)) continue;
        const auto next = grid(col + dc, row + dr);
        if (next < 0) continue;
        const auto& points = surface.point_in_camera;
        spacing.push_back((points[static_cast<std::size_t>(here)] - points[static_cast<std::size_t>(next)]).norm());
      }
    }
  }
  if (spacing.size() < 20) return 0;
  const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
  std::nth_element(spacing.begin(), middle, spacing.end());
  return *middle;
}

std::vector<std::uint32_t> VerticesIn(const Image<std::int32_t>& grid, const Box& box, std::size_t at_most) {
  std::vector<std::uint32_t> vertices;
  const double count = (box.right - box.left + 1.0) * (box.bottom - box.top + 1.0);
  const int step = std::max(1, static_cast<int>(std::sqrt(count / static_cast<double>(at_most))));
  for (int row = box.top; row <= box.bottom; row += step) {
    for (int col = box.left; col <= box.right; col += step) {
      if (grid(col, row) >= 0) vertices.push_back(static_cast<std::uint32_t>(grid(col, row)));
    }
  }
  return vertices;
}

void AverageCells(const Surface& surface, const Image<std::int32_t>& grid, Patch& patch) {
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double uncertainty = 0;
      int count = 0;
      for (int r = 0; r < patch.bin_px; ++r) {
        for (int c = 0; c < patch.bin_px; ++c) {
          const int col = patch.col0_px + i * patch.bin_px + c, row = patch.row0_px + j * patch.bin_px + r;
          const auto index = grid.Contains(col, row) ? grid(col, row) : -1;
          if (index < 0) continue;
          const auto vertex = static_cast<std::size_t>(index);
          sum += surface.point_in_camera[vertex].cast<double>();
          if (!surface.uncertainty_mm.empty()) uncertainty += static_cast<double>(surface.uncertainty_mm[vertex]);
          ++count;
        }
      }
      if (2 * count < patch.bin_px * patch.bin_px) continue;
      patch.point[patch.At(i, j)] = sum / count;
      patch.uncertainty_mm[patch.At(i, j)] = static_cast<float>(uncertainty / count);
      patch.state[patch.At(i, j)] = Patch::kMeasured;
    }
  }
}

}  // namespace

void RayModel::Fit(const Surface& surface, const std::vector<std::uint32_t>& vertices) {
  centre_px_.setZero();
  for (const auto v : vertices) centre_px_ += Eigen::Vector2d(surface.col[v], surface.row[v]);
  centre_px_ /= static_cast<double>(vertices.size());
  scale_px_ = 1;
  for (const auto v : vertices) {
    scale_px_ =
        std::max(scale_px_, (Eigen::Vector2d(surface.col[v], surface.row[v]) - centre_px_).cwiseAbs().maxCoeff());
  }
  Eigen::MatrixXd terms(static_cast<Eigen::Index>(vertices.size()), 10);
  Eigen::MatrixXd directions(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Eigen::Vector2d at =
        (Eigen::Vector2d(surface.col[vertices[k]], surface.row[vertices[k]]) - centre_px_) / scale_px_;
    terms.row(static_cast<Eigen::Index>(k)) = CubicTerms(at.x(), at.y());
    directions.row(static_cast<Eigen::Index>(k)) =
        surface.point_in_camera[vertices[k]].cast<double>().normalized().transpose();
  }
  coefficients_ = terms.colPivHouseholderQr().solve(directions);
}

Eigen::Vector3d RayModel::Direction(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d at = (pixel - centre_px_) / scale_px_;
  return (CubicTerms(at.x(), at.y()) * coefficients_).transpose().normalized();
}

Result<Patch> CutPatch(const Surface& surface, const std::vector<Eigen::Vector2d>& polygon_px, double cell_mm,
                       double reach_mm) {
  const Image<std::int32_t> grid = VertexIndexGrid(surface);
  Patch patch;
  patch.pixel_mm = MedianSpacing(surface, grid, BoundingBox(polygon_px, 2, surface));
  if (!(patch.pixel_mm > 0)) {
    return Fail(ErrorCode::kOutlineOffSurface,
                "hardly any reconstructed point lies at the outline; draw it on the photograph that this surface was "
                "made from, in sensor pixels");
  }
  patch.bin_px = std::max(1, static_cast<int>(std::lround(cell_mm / patch.pixel_mm)));
  const Box box = BoundingBox(polygon_px, reach_mm / patch.pixel_mm, surface);
  patch.col0_px = box.left;
  patch.row0_px = box.top;
  patch.width = (box.right - box.left + patch.bin_px) / patch.bin_px;
  patch.height = (box.bottom - box.top + patch.bin_px) / patch.bin_px;
  patch.point.assign(static_cast<std::size_t>(patch.width) * static_cast<std::size_t>(patch.height),
                     Eigen::Vector3d::Zero());
  patch.state.assign(patch.point.size(), Patch::kMissing);
  patch.uncertainty_mm.assign(patch.point.size(), 0);
  patch.rays.Fit(surface, VerticesIn(grid, box, 4000));
  AverageCells(surface, grid, patch);
  return patch;
}

double ShareBeyond(const Patch& patch, const std::vector<std::uint8_t>& region, double reach_mm) {
  std::vector<std::uint8_t> near(patch.size());
  std::vector<std::size_t> front;
  for (std::size_t cell = 0; cell < patch.size(); ++cell) {
    near[cell] = patch.state[cell] == Patch::kMeasured ? 1 : 0;
    if (near[cell] != 0) front.push_back(cell);
  }
  for (double reached = 0; reached < reach_mm; reached += patch.cell_mm()) {
    std::vector<std::size_t> next_front;
    for (const auto cell : front) {
      ForNeighbours(patch, cell, [&](std::size_t next) {
        if (near[next] != 0) return;
        near[next] = 1;
        next_front.push_back(next);
      });
    }
    front = std::move(next_front);
  }
  double all = 0, beyond = 0;
  for (std::size_t cell = 0; cell < patch.size(); ++cell) {
    all += region[cell];
    beyond += region[cell] != 0 && near[cell] == 0 ? 1 : 0;
  }
  return all > 0 ? beyond / all : 0;
}

void FillHoles(Patch& patch, const std::vector<std::uint8_t>& wanted) {
  std::vector<double> range(patch.size(), 0);
  std::vector<std::size_t> front, filled;
  for (std::size_t cell = 0; cell < patch.size(); ++cell) {
    if (patch.state[cell] != Patch::kMissing) range[cell] = patch.point[cell].norm();
    if (patch.state[cell] == Patch::kMissing && wanted[cell] != 0) front.push_back(cell);
  }
  const auto mean_of_neighbours = [&](std::size_t cell) {
    double sum = 0;
    int count = 0;
    ForNeighbours(patch, cell, [&](std::size_t next) {
      if (patch.state[next] == Patch::kMissing) return;
      sum += range[next];
      ++count;
    });
    return count > 0 ? sum / count : 0.0;
  };
  while (!front.empty()) {  // from the hole's rim inwards, for a start
    std::vector<std::size_t> done, later;
    for (const auto cell : front) {
      range[cell] = mean_of_neighbours(cell);
      (range[cell] > 0 ? done : later).push_back(cell);
    }
    if (done.empty()) break;
    for (const auto cell : done) patch.state[cell] = Patch::kFilled;
    filled.insert(filled.end(), done.begin(), done.end());
    front = std::move(later);
  }
  for (int sweep = 0; sweep < 100; ++sweep) {  // then towards the membrane
    for (const auto cell : filled) range[cell] = mean_of_neighbours(cell);
  }
  const auto width = static_cast<std::size_t>(patch.width);
  for (const auto cell : filled) {
    const auto pixel = patch.Pixel(static_cast<int>(cell % width), static_cast<int>(cell / width));
    patch.point[cell] = range[cell] * patch.rays.Direction(pixel);
  }
}

std::vector<std::uint8_t> ConnectedSheet(const Patch& patch, const std::vector<std::uint8_t>& seeds,
                                         const std::vector<std::uint8_t>& allowed) {
  const double jump_mm = kJumpCells * patch.cell_mm();
  std::vector<std::uint8_t> best(patch.size(), 0), seen(patch.size(), 0);
  std::size_t best_seeds = 0;
  for (std::size_t start = 0; start < patch.size(); ++start) {
    if (seeds[start] == 0 || seen[start] != 0 || patch.state[start] != Patch::kMeasured) continue;
    std::vector<std::size_t> sheet = {start};
    seen[start] = 1;
    std::size_t seeds_in_sheet = 0;
    for (std::size_t k = 0; k < sheet.size(); ++k) {
      const auto cell = sheet[k];
      if (seeds[cell] != 0) ++seeds_in_sheet;
      const double range = patch.point[cell].norm();
      ForNeighbours(patch, cell, [&](std::size_t next) {
        if (seen[next] != 0 || allowed[next] == 0 || patch.state[next] != Patch::kMeasured) return;
        if (std::abs(patch.point[next].norm() - range) > jump_mm) return;
        seen[next] = 1;
        sheet.push_back(next);
      });
    }
    if (seeds_in_sheet <= best_seeds) continue;
    best_seeds = seeds_in_sheet;
    std::fill(best.begin(), best.end(), std::uint8_t{0});
    for (const auto cell : sheet) best[cell] = 1;
  }
  return best;
}

}  // namespace striae::wound
