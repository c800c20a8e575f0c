#include "app/wound_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

namespace striae::app {
namespace {

using Eigen::Vector3d;

constexpr int kWidth_px = 720, kMargin_px = 12;
constexpr double kTurn = 0.5, kRise = 0.7;  // rad: about the skin's normal, and above the skin
constexpr double kNet_mm = 4;               // between the lines of the virtual skin
constexpr double kAmbient = 0.35;
constexpr Rgb8 kBoundary{40, 220, 255}, kNet{30, 60, 160};

/// Right and up on the picture and towards the eye, along which what is nearer hides what is behind.
struct Eye {
  Vector3d right{std::cos(kTurn), std::sin(kTurn), 0}, up, near;
  Eye() {
    const Vector3d back(-std::sin(kTurn), std::cos(kTurn), 0);
    up = std::sin(kRise) * back + std::cos(kRise) * Vector3d::UnitZ();
    near = -std::cos(kRise) * back + std::sin(kRise) * Vector3d::UnitZ();
  }
  [[nodiscard]] Vector3d Of(const Vector3d& p) const { return {p.dot(right), p.dot(up), p.dot(near)}; }
};

class Canvas {
 public:
  Canvas(const std::vector<Vector3d>& seen) {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& p : seen) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    left_ = low.x();
    top_ = high.y();
    scale_ = (kWidth_px - 2 * kMargin_px) / std::max(1e-6, high.x() - low.x());
    const int height = 2 * kMargin_px + static_cast<int>(std::ceil(scale_ * (high.y() - low.y())));
    picture = ImageRgb(kWidth_px, std::clamp(height, 1, 3 * kWidth_px), Rgb8{255, 255, 255});
    nearest_ = ImageF(picture.width(), picture.height(), -std::numeric_limits<float>::infinity());
  }

  /// Column, row and nearness.
  [[nodiscard]] Vector3d Place(const Vector3d& seen) const {
    return {kMargin_px + scale_ * (seen.x() - left_), kMargin_px + scale_ * (top_ - seen.y()), seen.z()};
  }

  void Triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Rgb8& colour) {
    const auto cross = [](const Vector3d& p, const Vector3d& q, double x, double y) {
      return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
    };
    const double area = cross(a, b, c.x(), c.y());
    if (std::abs(area) < 1e-12) return;
    const auto first = [](double x) { return static_cast<int>(std::ceil(x)); };
    for (int y = first(std::min({a.y(), b.y(), c.y()})); y <= std::max({a.y(), b.y(), c.y()}); ++y) {
      for (int x = first(std::min({a.x(), b.x(), c.x()})); x <= std::max({a.x(), b.x(), c.x()}); ++x) {
        const double u = cross(b, c, x, y) / area, v = cross(c, a, x, y) / area, w = 1 - u - v;
        if (u < -1e-9 || v < -1e-9 || w < -1e-9 || !picture.Contains(x, y)) continue;
        const auto near = static_cast<float>(u * a.z() + v * b.z() + w * c.z());
        if (near <= nearest_(x, y)) continue;
        nearest_(x, y) = near;
        picture(x, y) = colour;
      }
    }
  }

  /// Covers what lies behind it by `share`.
  void Line(const Vector3d& a, const Vector3d& b, const Rgb8& colour, double share, double thick_px) {
    constexpr float kAbove_mm = 0.4F;  // lines that lie on the surface are not to be lost in it
    const int steps = 1 + static_cast<int>(1.5 * (b - a).head<2>().norm());
    for (int k = 0; k <= steps; ++k) {
      const Vector3d p = a + (b - a) * k / steps;
      for (double dy = -thick_px / 2; dy <= thick_px / 2; dy += 1) {
        const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y() + dy));
        if (!picture.Contains(x, y) || static_cast<float>(p.z()) + kAbove_mm < nearest_(x, y)) continue;
        const auto mix = [&](std::uint8_t under, std::uint8_t over) {
          return static_cast<std::uint8_t>(std::lround((1 - share) * under + share * over));
        };
        Rgb8& pixel = picture(x, y);
        pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b)};
      }
    }
  }

  ImageRgb picture;

 private:
  double left_ = 0, top_ = 0, scale_ = 1;
  ImageF nearest_;
};

Vector3d BedAt(const wound::WoundMaps& maps, int i, int j) {
  return {maps.u_mm(i, j), maps.v_mm(i, j), maps.bed_mm(i, j)};
}

Rgb8 Shaded(const Rgb8& colour, const Vector3d& normal) {
  static const Vector3d kLight = Vector3d(-0.5, 0.6, 0.8).normalized();
  const double light = kAmbient + (1 - kAmbient) * std::max(0.0, normal.dot(kLight));
  const auto lit = [&](std::uint8_t value) { return static_cast<std::uint8_t>(std::lround(light * value)); };
  return {lit(colour.r), lit(colour.g), lit(colour.b)};
}

void DrawSurface(const wound::WoundMaps& maps, const ImageRgb& colours, const Eye& eye, Canvas& canvas) {
  const double most_mm = 12 * maps.cell_mm;  // a longer side is a jump, not a surface
  for (int j = 0; j + 1 < maps.bed_mm.height(); ++j) {
    for (int i = 0; i + 1 < maps.bed_mm.width(); ++i) {
      const std::array<Vector3d, 4> p = {BedAt(maps, i, j), BedAt(maps, i + 1, j), BedAt(maps, i + 1, j + 1),
                                         BedAt(maps, i, j + 1)};
      for (const auto& [a, b, c] : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        const Vector3d &pa = p[static_cast<std::size_t>(a)], &pb = p[static_cast<std::size_t>(b)],
                       &pc = p[static_cast<std::size_t>(c)];
        if (!pa.allFinite() || !pb.allFinite() || !pc.allFinite()) continue;
        if ((pb - pa).norm() > most_mm || (pc - pa).norm() > most_mm) continue;
        Vector3d normal = (pb - pa).cross(pc - pa).normalized();
        if (normal.z() < 0) normal = -normal;
        canvas.Triangle(canvas.Place(eye.Of(pa)), canvas.Place(eye.Of(pb)), canvas.Place(eye.Of(pc)),
                        Shaded(colours(i, j), normal));
      }
    }
  }
}

// One triangle's share of the net: where its first or second coordinate is a multiple of the net's step.
void DrawNetAcross(const std::array<Vector3d, 3>& skin, const Eye& eye, Canvas& canvas) {
  for (const int along : {0, 1}) {
    const double low = std::min({skin[0][along], skin[1][along], skin[2][along]});
    const double line = kNet_mm * (std::floor(low / kNet_mm) + 1);
    std::vector<Vector3d> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d &a = skin[k], &b = skin[(k + 1) % 3];
      if ((a[along] < line) == (b[along] < line)) continue;
      ends.emplace_back(a + (b - a) * (line - a[along]) / (b[along] - a[along]));
    }
    if (ends.size() == 2) canvas.Line(canvas.Place(eye.Of(ends[0])), canvas.Place(eye.Of(ends[1])), kNet, 0.7, 1);
  }
}

// The virtual skin where it lies above the bed.
void DrawNet(const wound::WoundMaps& maps, const Eye& eye, Canvas& canvas) {
  constexpr float kLeast_mm = 0.2F;
  const auto above = [&](int i, int j) { return maps.depth_mm(i, j) > kLeast_mm; };
  const auto skin = [&](int i, int j) { return Vector3d(maps.u_mm(i, j), maps.v_mm(i, j), maps.skin_mm(i, j)); };
  for (int j = 0; j + 1 < maps.skin_mm.height(); ++j) {
    for (int i = 0; i + 1 < maps.skin_mm.width(); ++i) {
      if (!above(i, j) || !above(i + 1, j) || !above(i, j + 1) || !above(i + 1, j + 1)) continue;
      DrawNetAcross({skin(i, j), skin(i + 1, j), skin(i + 1, j + 1)}, eye, canvas);
      DrawNetAcross({skin(i, j), skin(i + 1, j + 1), skin(i, j + 1)}, eye, canvas);
    }
  }
}

}  // namespace

ImageRgb ViewOfWound(const wound::WoundMaps& maps, const ImageRgb& colours) {
  const Eye eye;
  std::vector<Vector3d> seen;
  for (int j = 0; j < maps.bed_mm.height(); ++j) {
    for (int i = 0; i < maps.bed_mm.width(); ++i) {
      const Vector3d p = BedAt(maps, i, j);
      if (p.allFinite()) seen.push_back(eye.Of(p));
    }
  }
  if (seen.empty()) return {kWidth_px, kWidth_px, Rgb8{255, 255, 255}};
  Canvas canvas(seen);
  DrawSurface(maps, colours, eye, canvas);
  DrawNet(maps, eye, canvas);
  const std::size_t n = maps.boundary_mm.size();
  for (std::size_t k = 0; k < n; ++k) {
    canvas.Line(canvas.Place(eye.Of(maps.boundary_mm[k])), canvas.Place(eye.Of(maps.boundary_mm[(k + 1) % n])),
                kBoundary, 1, 3);
  }
  return canvas.picture;
}

}  // namespace striae::app
