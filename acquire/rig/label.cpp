#include "acquire/rig/label.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/aruco.hpp>

namespace striae::rig {
namespace {

constexpr int kMarkerCells = 6, kPaperCells = kMarkerCells + 2;  // 4 bits and the black border; one white cell around
constexpr float kInk = 0.035F, kPaper = 0.78F;                   // office laser print

/// Place along the line (in units of `along`) where it meets the mesh; of several the one that `better` prefers.
template <typename Better>
std::optional<double> Meet(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                           const Better& better) {
  std::optional<double> best;
  for (const auto& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.vertex[t[0]];
    const Eigen::Vector3d ab = mesh.vertex[t[1]] - a, ac = mesh.vertex[t[2]] - a, start = from - a;
    const Eigen::Vector3d p = along.cross(ac);
    const double determinant = ab.dot(p);
    if (determinant == 0) continue;
    const double u = start.dot(p) / determinant;
    if (u < -1e-9 || u > 1 + 1e-9) continue;
    const Eigen::Vector3d q = start.cross(ab);
    const double v = along.dot(q) / determinant;
    if (v < -1e-9 || u + v > 1 + 1e-9) continue;
    const double place = ac.dot(q) / determinant;
    if (!best || better(place, *best)) best = place;
  }
  return best;
}

/// Mean outward normal of the surface around the place, towards the camera.
Eigen::Vector3d NormalAround(const TriangleMesh& mesh, const Eigen::Vector3d& place, double radius_mm) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.vertex[t[0]];
    const Eigen::Vector3d normal = (mesh.vertex[t[1]] - a).cross(mesh.vertex[t[2]] - a);
    const Eigen::Vector3d middle = (a + mesh.vertex[t[1]] + mesh.vertex[t[2]]) / 3;
    if ((middle - place).norm() <= radius_mm && normal.dot(middle) < 0) sum += normal;
  }
  return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d(-place.normalized());
}

Result<std::vector<float>> Cells(int id) {
  try {
    cv::Mat marker;
    cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000), id, kMarkerCells, marker, 1);
    std::vector<float> cells(static_cast<std::size_t>(kPaperCells * kPaperCells), kPaper);
    for (int row = 0; row < kMarkerCells; ++row) {
      for (int column = 0; column < kMarkerCells; ++column) {
        cells[static_cast<std::size_t>((row + 1) * kPaperCells + column + 1)] =
            marker.at<std::uint8_t>(row, column) != 0 ? kPaper : kInk;
      }
    }
    return cells;
  } catch (const cv::Exception& error) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV cannot draw the label's marker: ") + error.what());
  }
}

}  // namespace

Result<LabelTruth> PaintLabel(const LabelOptions& o, TriangleMesh& mesh) {
  if (o.id < 0 || o.id > 999) return Fail(ErrorCode::kUsage, "a label's id lies between 0 and 999 (DICT_4X4_1000)");
  if (!(o.side_mm > 0) || !std::isfinite(o.side_mm + o.x_mm + o.y_mm + o.turn_deg)) {
    return Fail(ErrorCode::kUsage, "a label needs a positive side and a finite place");
  }
  const auto depth = Meet(mesh, {o.x_mm, o.y_mm, 0}, Eigen::Vector3d::UnitZ(),
                          [](double place, double best) { return place > 0 && (best <= 0 || place < best); });
  if (!depth || *depth <= 0) {
    return Fail(ErrorCode::kUsage,
                fmt::format("there is no surface at x = {:g} mm, y = {:g} mm to put the label on", o.x_mm, o.y_mm));
  }
  auto cells = Cells(o.id);
  if (!cells) return Fail(cells.error());
  Decal decal;
  decal.origin = {o.x_mm, o.y_mm, *depth};
  decal.cell_mm = o.side_mm / kMarkerCells;
  decal.columns = decal.rows = kPaperCells;
  decal.albedo = std::move(*cells);
  decal.reach_mm = o.side_mm / 2;
  const Eigen::Vector3d normal = NormalAround(mesh, decal.origin, o.side_mm / 2);
  const Eigen::AngleAxisd turn(o.turn_deg * std::numbers::pi / 180, -normal);
  const Eigen::Vector3d level = Eigen::Vector3d::UnitX() - normal.x() * normal;  // as upright as the surface allows
  if (level.norm() < 1e-3) return Fail(ErrorCode::kUsage, "the surface is seen edge-on where the label should be");
  decal.right = turn * level.normalized();
  decal.down = (-normal).cross(decal.right);
  LabelTruth truth;
  constexpr std::array<std::array<double, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d flat =
        decal.origin + o.side_mm / 2 * (kCorners[i][0] * decal.right + kCorners[i][1] * decal.down);
    const auto lift =
        Meet(mesh, flat, normal, [](double place, double best) { return std::abs(place) < std::abs(best); });
    if (!lift || std::abs(*lift) > decal.reach_mm) {
      return Fail(ErrorCode::kUsage,
                  fmt::format("the body ends within the label of {:g} mm at x = {:g} mm, y = {:g} mm; make it smaller "
                              "or move it",
                              o.side_mm, o.x_mm, o.y_mm));
    }
    truth.corner_in_camera[i] = flat + *lift * normal;
  }
  mesh.decal.push_back(std::move(decal));
  return truth;
}

}  // namespace striae::rig
