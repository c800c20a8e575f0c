#include "acquire/rig/ball.h"

#include <cmath>
#include <numbers>

namespace striae::rig {

Result<TriangleMesh> MakeBall(const BallOptions& options) {
  if (!(options.radius_mm > 0) || !options.center_mm.allFinite() || !(options.center_mm.norm() > options.radius_mm)) {
    return Fail(ErrorCode::kUsage, "a ball needs a positive radius and a place away from the camera");
  }
  // Chords of 2 pi / 1000: their middle lies (pi / 1000)^2 / 2 = 5e-6 of the radius inside of the sphere.
  constexpr int kColumns = 1000, kRows = 501;
  TriangleMesh mesh;
  for (int row = 0; row < kRows; ++row) {
    const double polar = std::numbers::pi * row / (kRows - 1);
    for (int column = 0; column < kColumns; ++column) {
      const double around = 2 * std::numbers::pi * column / kColumns - std::numbers::pi;
      const Eigen::Vector3d out(std::sin(polar) * std::sin(around), -std::cos(polar),
                                -std::sin(polar) * std::cos(around));
      mesh.vertex.push_back(options.center_mm + options.radius_mm * out);
      mesh.normal.push_back(out);
    }
  }
  mesh.albedo.assign(mesh.vertex.size(), Eigen::Vector3f::Constant(static_cast<float>(options.albedo)));
  AppendGridTriangles(0, kColumns, kRows, true, mesh);
  return mesh;
}

}  // namespace striae::rig
