// A surface that still lies on the sensor's grid.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/ply_layout.h"
#include "core/surface.h"

namespace striae::reconstruct {

/// Half as large as the Surface of lists that it can become, and written to a PLY straight from the grid: lists of
/// millions of points and faces cost more to make than to encode.
class SensorSurface {
 public:
  struct Grid;  ///< reconstruct/detail/sensor_grid.h

  SensorSurface();
  explicit SensorSurface(std::unique_ptr<Grid> grid);
  SensorSurface(SensorSurface&&) noexcept;
  SensorSurface& operator=(SensorSurface&&) noexcept;
  ~SensorSurface();

  /// Depth in mm, NaN where there is no point; the grid must be there.
  [[nodiscard]] const ImageF& depth() const;
  [[nodiscard]] std::size_t points() const;
  [[nodiscard]] std::size_t faces() const;
  /// The grid is given up, so that the lists find room.
  Surface ToSurface() &&;
  /// Of the PLY, but for its header.
  [[nodiscard]] std::size_t FileBytes() const;
  /// The bytes of EncodePly(ToSurface()), in pieces as SendInOrder.
  [[nodiscard]] bool EncodePly(const PieceSink& sink) const;

  std::vector<std::string> comments;  ///< as Surface's

 private:
  std::unique_ptr<Grid> grid_;
};

}  // namespace striae::reconstruct
