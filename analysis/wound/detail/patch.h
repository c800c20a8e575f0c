// The part of a surface around an outline, averaged to cells of about the same size in every surface.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/surface.h"

namespace striae::wound {

/// Unit direction of the ray through a sensor position, as a cubic polynomial in (col, row): the surface file does not
/// carry the camera, but every point lies on its pixel's ray.
class RayModel {
 public:
  void Fit(const Surface& surface, const std::vector<std::uint32_t>& vertices);
  [[nodiscard]] Eigen::Vector3d Direction(const Eigen::Vector2d& pixel) const;

 private:
  Eigen::Vector2d centre_px_ = Eigen::Vector2d::Zero();
  double scale_px_ = 1;
  Eigen::Matrix<double, 10, 3> coefficients_ = Eigen::Matrix<double, 10, 3>::Zero();
};

/// A grid of cells, each the mean of bin x bin sensor pixels. Row-major.
struct Patch {
  enum State : std::uint8_t { kMissing = 0, kMeasured = 1, kFilled = 2 };

  int width = 0, height = 0;
  int bin_px = 1;
  int col0_px = 0, row0_px = 0;        ///< first sensor pixel of cell (0, 0)
  double pixel_mm = 0;                 ///< median distance between neighbouring surface points
  std::vector<Eigen::Vector3d> point;  ///< camera frame, mm
  std::vector<State> state;
  std::vector<float> uncertainty_mm;  ///< mean standard uncertainty of the cell's points; 0 where none is known
  RayModel rays;

  [[nodiscard]] double cell_mm() const { return pixel_mm * bin_px; }
  [[nodiscard]] std::size_t size() const { return point.size(); }
  [[nodiscard]] std::size_t At(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] double UncertaintyMm(std::size_t cell) const { return static_cast<double>(uncertainty_mm[cell]); }
  /// Sensor position of a cell's centre.
  [[nodiscard]] Eigen::Vector2d Pixel(int i, int j) const {
    const double half = (bin_px - 1) / 2.0;
    return {col0_px + i * bin_px + half, row0_px + j * bin_px + half};
  }
};

/// Calls `visit` with each of the up to four cells beside one.
template <typename Visit>
void ForNeighbours(const Patch& patch, std::size_t cell, Visit visit) {
  const auto width = static_cast<std::size_t>(patch.width);
  const auto i = cell % width;
  if (i > 0) visit(cell - 1);
  if (i + 1 < width) visit(cell + 1);
  if (cell >= width) visit(cell - width);
  if (cell + width < patch.size()) visit(cell + width);
}

/// Cuts out everything within `reach_mm` of the polygon. kOutlineOffSurface when hardly any point lies there.
Result<Patch> CutPatch(const Surface& surface, const std::vector<Eigen::Vector2d>& polygon_px, double cell_mm,
                       double reach_mm);

/// Share of the cells in `region` that have no measured cell within `reach_mm` (city-block steps).
double ShareBeyond(const Patch& patch, const std::vector<std::uint8_t>& region, double reach_mm);

/// Fills missing cells where `wanted` is set with the smoothest ranges that meet their measured neighbours (membrane).
void FillHoles(Patch& patch, const std::vector<std::uint8_t>& wanted);

/// Cells of one connected sheet: starts from the largest connected part of `seeds`, walks over `allowed` measured
/// cells, and never crosses a jump in range (a silhouette or a fold).
std::vector<std::uint8_t> ConnectedSheet(const Patch& patch, const std::vector<std::uint8_t>& seeds,
                                         const std::vector<std::uint8_t>& allowed);

}  // namespace striae::wound
