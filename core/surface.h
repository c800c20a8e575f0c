// A measured surface: one vertex per valid sensor pixel, on that pixel's ray (CONTRACT "Surface").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/buffer.h"
#include "core/image.h"

namespace striae {

struct Surface {
  int sensor_width_px = 0, sensor_height_px = 0;
  Buffer<Eigen::Vector3f> point_in_camera;  ///< mm; row-major order of (row, col)
  Buffer<Rgb8> colour;                      ///< one per point
  Buffer<float> quality;                    ///< modulation 0..1, one per point
  /// Standard uncertainty of the point along its ray, mm of depth; one per point, or empty where it is not known.
  Buffer<float> uncertainty_mm;
  Buffer<std::uint16_t> col, row;              ///< sensor pixel, one per point
  Buffer<std::array<std::uint32_t, 3>> faces;  ///< counter-clockwise seen from the camera (normals towards it)
  std::vector<std::string> comments;           ///< provenance lines, printable ASCII

  [[nodiscard]] std::size_t size() const { return point_in_camera.size(); }
  [[nodiscard]] bool HasGrid() const { return col.size() == size() && row.size() == size() && sensor_width_px > 0; }
};

/// A surface carries what is doubtful about it in its comments, through PLY too.
std::string WarningComment(const std::string& warning);
/// The warnings among the comments, without their mark.
std::vector<std::string> Warnings(const Surface& surface);

/// Vertex index of every sensor pixel, -1 where there is no point. Size sensor_width_px x sensor_height_px.
Image<std::int32_t> VertexIndexGrid(const Surface& surface);

}  // namespace striae
