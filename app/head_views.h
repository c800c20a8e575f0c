// Point surfaces seen from the subject's front, right side and top, side by side on one scale.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/image.h"
#include "core/surface.h"

namespace striae::app {

/// Points in subject axes (X forward, Y up, Z to the subject's right), mm, each with what it is painted with.
struct Painted {
  std::vector<Eigen::Vector3f> point;
  std::vector<Rgb8> colour;
  bool lit = true;  ///< shaded by the surface's slope; residuals keep their own colour
};

enum class View { kFront, kSide, kTop };
inline constexpr std::array<View, 3> kViews = {View::kFront, View::kSide, View::kTop};

/// Where every view lies in the picture: the same box, in mm of subject axes, for all layers. Above and below the views
/// is room for words.
class Layout {
 public:
  static constexpr int kHeader = 44, kFooter = 24;  ///< px, for words

  /// Round the points' 0.5 to 99.5 percentiles and all of `besides`, with a margin; `points` must not be empty.
  explicit Layout(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3d>& besides = {});
  [[nodiscard]] Eigen::Vector2d PixelOf(View view, const Eigen::Vector3d& in_subject) const;
  /// First column, and width, height of a view, px.
  [[nodiscard]] std::array<int, 3> Panel(View view) const;
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

 private:
  Eigen::Vector3d low_, high_;
};

/// White where there is no point; the nearest point of a layer hides those behind it. Two layers that both show
/// are mixed in equal parts.
ImageRgb PaintViews(const Layout& layout, const std::vector<Painted>& layers);

/// The surface's points, at most about 250 000 in even steps, after `motion` (in camera axes) in subject axes.
std::vector<Eigen::Vector3f> PointsInSubject(const Surface& surface, const Eigen::Isometry3d& motion,
                                             const Eigen::Matrix3d& subject_from_camera);

}  // namespace striae::app
