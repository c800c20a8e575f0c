#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "acquire/rig/detail/dress.h"
#include "acquire/rig/detail/texture.h"

namespace striae::rig::detail {
namespace {

const Eigen::Vector3d kSkin(0.56, 0.36, 0.27);

struct Knot {
  Eigen::Vector3d centre;
  double radius;
};

// Shoulder, elbow, forearm, wrist, knuckles, finger tips; x to the subject's left, y down, z backwards.
const std::array<Knot, 8> kKnots = {{{{178, 118, -10}, 50},
                                     {{215, 190, -60}, 46},
                                     {{205, 250, -135}, 43},
                                     {{110, 225, -185}, 42},
                                     {{0, 180, -195}, 35},
                                     {{-75, 148, -200}, 27},
                                     {{-140, 118, -200}, 34},
                                     {{-205, 88, -196}, 9}}};

/// Catmull and Rom's spline through the knots, t from 0 to the number of spans.
Knot At(double t) {
  const int last = static_cast<int>(kKnots.size()) - 1;
  const int span = std::clamp(static_cast<int>(t), 0, last - 1);
  const double s = t - span;
  const auto knot = [&](int i) { return kKnots[static_cast<std::size_t>(std::clamp(i, 0, last))]; };
  const Knot a = knot(span - 1), b = knot(span), c = knot(span + 1), d = knot(span + 2);
  const auto blend = [s](const auto& p, const auto& q, const auto& r, const auto& u) {
    return 0.5 * (2 * q + s * (r - p) + s * s * (2 * p - 5 * q + 4 * r - u) + s * s * s * (3 * q - p - 3 * r + u));
  };
  return {blend(a.centre, b.centre, c.centre, d.centre).eval(), blend(a.radius, b.radius, c.radius, d.radius)};
}

}  // namespace

TriangleMesh MakeArm(unsigned seed) {
  constexpr int kColumns = 240, kRows = 560;
  TriangleMesh mesh;
  const double spans = static_cast<double>(kKnots.size() - 1);
  for (int row = 0; row < kRows; ++row) {
    const double t = spans * row / (kRows - 1);
    const Knot here = At(t);
    const Eigen::Vector3d along =
        (At(std::min(spans, t + 1e-4)).centre - At(std::max(0.0, t - 1e-4)).centre).normalized();
    // The ring's own axes: e towards the camera, f to the side; columns run as AppendGridTriangles wants them.
    const Eigen::Vector3d e = (-Eigen::Vector3d::UnitZ() + along.z() * along).normalized(), f = e.cross(along);
    const double hand = SmootherStep(4.6, 5.8, t);  // flat, and rounded at the finger tips
    const double end = std::sqrt(std::max(0.0, 1 - std::pow(std::max(0.0, (t - spans + 0.3) / 0.3), 2)));
    for (int column = 0; column < kColumns; ++column) {
      const double around = 2 * std::numbers::pi * column / kColumns - std::numbers::pi;
      const double depth = here.radius * end * (1 - 0.55 * hand), breadth = here.radius * end * (1 + 0.1 * hand);
      mesh.vertex.push_back(here.centre + depth * std::cos(around) * e + breadth * std::sin(around) * f);
      mesh.albedo.push_back(Skin(kSkin, mesh.vertex.back(), 0.10, seed + 5));
    }
  }
  AppendGridTriangles(0, kColumns, kRows, true, mesh);
  ComputeNormals(mesh);
  return mesh;
}

}  // namespace striae::rig::detail
