#include "acquire/rig/detail/bust_parts.h"

#include <cmath>
#include <numbers>

#include "acquire/rig/detail/texture.h"

namespace striae::rig::detail {
namespace {

constexpr double kPi = std::numbers::pi;
const Eigen::Vector3d kSkin(0.56, 0.36, 0.27), kLips(0.50, 0.22, 0.19);
const Eigen::Vector3d kHeadCentre(0, -128, -12), kHeadHalf(75, 112, 95);

double Bump(double x, double y, double cx, double cy, double sx, double sy) {
  return std::exp(-0.5 * (std::pow((x - cx) / sx, 2) + std::pow((y - cy) / sy, 2)));
}

/// Relief of the face at (x, y) mm from the head's middle as seen from the front, mm; a little unlike left and right.
double FaceRelief(double x, double y) {
  double relief = 0;
  // Nose: a ridge that rises from between the brows to the tip and ends above the lip.
  const double ridge = SmootherStep(-30, 24, y) * (1 - SmootherStep(22, 35, y));
  relief += 25 * ridge * std::exp(-0.5 * std::pow((x - 0.8 - 0.02 * y) / (7 + 4 * SmootherStep(0, 25, y)), 2));
  relief += 6 * Bump(x, y, -12, 23, 5, 5) + 5.5 * Bump(x, y, 13.5, 24, 5, 5);
  // Eye sockets with eyeballs under the brows.
  for (const double side : {-1.0, 1.0}) {
    relief += -11 * Bump(x, y, side * 31, -14 + side, 14, 9) + 6 * Bump(x, y, side * 31, -13 + side, 9, 6);
    relief += 5 * Bump(x, y, side * 27, -30 + 0.6 * side, 19, 5.5);
    relief += (5 + 0.6 * side) * Bump(x, y, side * 44, 14, 16, 13);
    relief -= 4 * Bump(x, y, side * 42, 46, 13, 16);
  }
  relief += 5 * Bump(x, y, 0.5, 46, 17, 4.5) + 5.5 * Bump(x, y, 0, 57, 14, 4.5) - 3.5 * Bump(x, y, 0, 51.2, 19, 1.8);
  relief -= 4 * Bump(x, y, 0, 66, 18, 4);
  relief += 9 * Bump(x, y, -0.7, 84, 15, 12);
  return relief;
}

/// Joins a closed loft of rows to a mesh with normals and skin.
void Finish(int columns, int rows, unsigned seed, TriangleMesh& mesh) {
  mesh.albedo.reserve(mesh.vertex.size());
  for (std::size_t i = mesh.albedo.size(); i < mesh.vertex.size(); ++i) {
    mesh.albedo.push_back(Skin(kSkin, mesh.vertex[i], 0.10, seed));
  }
  AppendGridTriangles(0, columns, rows, true, mesh);
  ComputeNormals(mesh);
}

/// Superellipse radius towards (sin, -cos) for half widths a (x) and b (z).
double Superellipse(double angle, double a, double b, double exponent) {
  return std::pow(std::pow(std::abs(std::sin(angle)) / a, exponent) + std::pow(std::abs(std::cos(angle)) / b, exponent),
                  -1 / exponent);
}

/// The torso's half widths grow from the neck over the shoulders.
double TorsoHalfWidth(double y) { return 54 + 140 * SmootherStep(8, 118, y) - 18 * SmootherStep(140, 380, y); }
double TorsoHalfDepth(double y) { return 52 + 52 * SmootherStep(10, 150, y); }

double TorsoRelief(double angle, double y) {
  const double x = 190 * std::sin(angle);  // place across the chest
  if (std::cos(angle) <= 0) return 0;      // the front only
  const double front = SmootherStep(0, 0.4, std::cos(angle));
  double relief = -9 * Bump(x, y, 0, 62, 11, 13);  // notch above the breastbone
  for (const double side : {-1.0, 1.0}) {
    const double collar = 66 - 0.10 * std::abs(x);  // the collar bones rise outwards
    relief += side * x > 0 ? 8 * SmootherStep(8, 30, std::abs(x)) * std::exp(-0.5 * std::pow((y - collar) / 6, 2)) : 0;
    relief += (19 + 2 * side) * Bump(x, y, side * 78, 200 + 3 * side, 46, 42);  // breast muscles
  }
  relief -= 5 * std::exp(-0.5 * std::pow(x / 10, 2)) * SmootherStep(110, 170, y);  // furrow between them
  return relief * front;
}

}  // namespace

TriangleMesh MakeHead(unsigned seed) {
  constexpr int kColumns = 720, kRows = 420;
  TriangleMesh mesh;
  for (int row = 0; row < kRows; ++row) {
    // From just under the crown to just above the lowest point: poles are not needed.
    const double polar = kPi * (0.004 + 0.992 * row / (kRows - 1));
    for (int column = 0; column < kColumns; ++column) {
      const double around = 2 * kPi * column / kColumns - kPi;
      const Eigen::Vector3d d(std::sin(polar) * std::sin(around), -std::cos(polar),
                              -std::sin(polar) * std::cos(around));
      Eigen::Vector3d p = d.cwiseProduct(kHeadHalf);
      p.x() *= 1 - 0.22 * SmootherStep(0, 100, p.y());                     // jaw
      p.z() *= p.z() > 0 ? 1 - 0.35 * SmootherStep(10, 110, p.y()) : 1.0;  // nape
      const double front = SmootherStep(0.1, 0.55, -d.z());
      p.z() -= front * FaceRelief(p.x(), p.y());
      for (const double side : {-1.0, 1.0}) {  // ears: flaps of different size and height
        const double ear =
            Bump(p.z(), p.y(), 12, side > 0 ? 2 : -3, 8, side > 0 ? 19 : 17) * SmootherStep(0.5, 0.9, side * d.x());
        p.x() += side * ear * (side > 0 ? 13 : 11);
        p.z() += 6 * ear;
      }
      const double lips = front * (Bump(p.x(), p.y(), 0, 51, 15, 5.5));
      mesh.vertex.push_back(kHeadCentre + p);
      mesh.albedo.push_back(Skin(kSkin + lips * (kLips - kSkin), mesh.vertex.back(), 0.10, seed));
    }
  }
  Finish(kColumns, kRows, seed, mesh);
  return mesh;
}

TriangleMesh MakeNeck(unsigned seed) {
  constexpr int kColumns = 420, kRows = 160;
  TriangleMesh mesh;
  for (int row = 0; row < kRows; ++row) {
    const double y = -95 + 150.0 * row / (kRows - 1);
    const double a = 53 + 8 * SmootherStep(-20, 45, y), b = 55;
    for (int column = 0; column < kColumns; ++column) {
      const double around = 2 * kPi * column / kColumns - kPi;
      double r = Superellipse(around, a, b, 2);
      r += 2.5 * std::exp(-std::pow((around - 0.15) / 0.18, 2)) * Bump(0, y, 0, -10, 1, 12);  // larynx, off the middle
      for (const double side : {-1.0, 1.0}) {                                                 // long neck muscles
        r += 3 * std::exp(-std::pow((side * around - 0.95 + 0.008 * (y + 20)) / 0.16, 2));
      }
      mesh.vertex.emplace_back(r * std::sin(around), y, 8 - r * std::cos(around));
    }
  }
  Finish(kColumns, kRows, seed, mesh);
  return mesh;
}

TriangleMesh MakeTorso(unsigned seed) {
  constexpr int kColumns = 1000, kRows = 560;
  TriangleMesh mesh;
  for (int row = 0; row < kRows; ++row) {
    const double t = static_cast<double>(row) / (kRows - 1);
    const double y = 2 + 420 * t * (0.35 + 0.65 * t);  // denser over the shoulders
    for (int column = 0; column < kColumns; ++column) {
      const double around = 2 * kPi * column / kColumns - kPi;
      const double r = Superellipse(around, TorsoHalfWidth(y), TorsoHalfDepth(y), 2.4) + TorsoRelief(around, y);
      mesh.vertex.emplace_back(r * std::sin(around), y, 14 - r * std::cos(around));
    }
  }
  Finish(kColumns, kRows, seed, mesh);
  return mesh;
}

}  // namespace striae::rig::detail
