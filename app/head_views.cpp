#include "app/head_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::app {
namespace {

constexpr double kPxPerMm = 0.8;
constexpr int kMargin = 12;                  // px
constexpr int kNarrowest = 230;              // px of a view: an angle's name, value and uncertainty stand above it
constexpr double kRim_mm = 15;               // about what is shown
constexpr double kTooWide_mm = 1200;         // what reaches farther is not a person
constexpr std::size_t kMostPoints = 250000;  // one for each pixel of the front view, about
constexpr int kSplat = 1;                    // px to either side
constexpr Rgb8 kPaper{255, 255, 255};

/// Across (to the right), down, and towards the viewer. From the side the viewer stands at the subject's right; from
/// the top the subject faces down the picture, so that columns are those of the front view.
Eigen::Vector3d InView(View view, const Eigen::Vector3d& p) {
  switch (view) {
    case View::kFront:
      return {-p.z(), -p.y(), p.x()};
    case View::kSide:
      return {p.x(), -p.y(), p.z()};
    case View::kTop:
      return {-p.z(), p.x(), p.y()};
  }
  return p;
}

struct Canvas {
  ImageF height;
  ImageRgb colour;
};

Canvas Splat(const Layout& layout, View view, const Painted& layer) {
  const auto [first, width, high] = layout.Panel(view);
  Canvas canvas{ImageF(width, high, -std::numeric_limits<float>::infinity()), ImageRgb(width, high, kPaper)};
  for (std::size_t k = 0; k < layer.point.size(); ++k) {
    const Eigen::Vector3d p = layer.point[k].cast<double>();
    const Eigen::Vector2d pixel = layout.PixelOf(view, p);
    if (!pixel.allFinite() || pixel.cwiseAbs().maxCoeff() > 1e6) continue;
    const int col = static_cast<int>(std::lround(pixel.x())) - first, row = static_cast<int>(std::lround(pixel.y()));
    const auto near = static_cast<float>(InView(view, p).z());
    for (int dy = -kSplat; dy <= kSplat; ++dy) {
      for (int dx = -kSplat; dx <= kSplat; ++dx) {
        if (!canvas.height.Contains(col + dx, row + dy) || canvas.height(col + dx, row + dy) >= near) continue;
        canvas.height(col + dx, row + dy) = near;
        canvas.colour(col + dx, row + dy) = layer.colour[k];
      }
    }
  }
  return canvas;
}

/// Light from the upper left of the viewer; flat where a neighbour is missing.
double Shade(const ImageF& height, int col, int row) {
  const auto slope = [&](int dx, int dy) {
    if (!height.Contains(col - dx, row - dy) || !height.Contains(col + dx, row + dy)) return 0.0;
    const double d = static_cast<double>(height(col + dx, row + dy)) - static_cast<double>(height(col - dx, row - dy));
    return std::isfinite(d) ? std::clamp(d * kPxPerMm / 2, -3.0, 3.0) : 0.0;
  };
  const Eigen::Vector3d normal = Eigen::Vector3d(-slope(2, 0) / 2, -slope(0, 2) / 2, 1).normalized();
  return 0.35 + 0.65 * std::max(0.0, normal.dot(Eigen::Vector3d(-0.35, -0.45, 0.82)));
}

std::uint8_t Byte(double value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))); }

}  // namespace

Layout::Layout(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3d>& besides) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    values.reserve(points.size());
    for (const auto& p : points) values.push_back(p[axis]);
    const auto at = [&](double share) {
      const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), place, values.end());
      return static_cast<double>(*place);
    };
    low_[axis] = at(0.005);
    high_[axis] = std::min(at(0.995), low_[axis] + kTooWide_mm);
    for (const auto& p : besides) {
      low_[axis] = std::min(low_[axis], p[axis]);
      high_[axis] = std::max(high_[axis], p[axis]);
    }
    low_[axis] -= kRim_mm;
    high_[axis] += kRim_mm;
  }
}

std::array<int, 3> Layout::Panel(View view) const {
  const Eigen::Vector3d size = (high_ - low_) * kPxPerMm;
  const auto px = [](double v) { return std::max(kNarrowest, static_cast<int>(std::ceil(v))); };
  const int front = px(size.z()), deep = px(size.x());
  switch (view) {
    case View::kFront:
      return {kMargin, front, height()};
    case View::kSide:
      return {2 * kMargin + front, deep, height()};
    case View::kTop:
      return {3 * kMargin + front + deep, front, height()};
  }
  return {};
}

int Layout::width() const {
  const auto [first, wide, high] = Panel(View::kTop);
  return first + wide + kMargin;
}

int Layout::height() const {
  return static_cast<int>(std::ceil(std::max(high_.y() - low_.y(), high_.x() - low_.x()) * kPxPerMm)) + kHeader +
         kFooter;
}

Eigen::Vector2d Layout::PixelOf(View view, const Eigen::Vector3d& in_subject) const {
  // The corner of the box that comes out at the panel's upper left.
  const Eigen::Vector3d corner = view == View::kFront  ? Eigen::Vector3d(0, high_.y(), high_.z())
                                 : view == View::kSide ? Eigen::Vector3d(low_.x(), high_.y(), 0)
                                                       : Eigen::Vector3d(low_.x(), 0, high_.z());
  const Eigen::Vector3d off = (InView(view, in_subject) - InView(view, corner)) * kPxPerMm;
  return {off.x() + Panel(view)[0], off.y() + kHeader};
}

ImageRgb PaintViews(const Layout& layout, const std::vector<Painted>& layers) {
  ImageRgb picture(layout.width(), layout.height(), kPaper);
  for (const View view : kViews) {
    const auto [first, width, high] = layout.Panel(view);
    ImageF sum[3] = {ImageF(width, high, 0), ImageF(width, high, 0), ImageF(width, high, 0)};
    Image<int> count(width, high, 0);
    for (const Painted& layer : layers) {
      const Canvas canvas = Splat(layout, view, layer);
      for (int row = 0; row < high; ++row) {
        for (int col = 0; col < width; ++col) {
          if (!std::isfinite(canvas.height(col, row))) continue;
          const double light = layer.lit ? Shade(canvas.height, col, row) : 1;
          const Rgb8 c = canvas.colour(col, row);
          sum[0](col, row) += static_cast<float>(light * c.r);
          sum[1](col, row) += static_cast<float>(light * c.g);
          sum[2](col, row) += static_cast<float>(light * c.b);
          ++count(col, row);
        }
      }
    }
    for (int row = 0; row < high; ++row) {
      for (int col = 0; col < width; ++col) {
        const int n = count(col, row);
        if (n == 0 || !picture.Contains(first + col, row)) continue;
        const auto mean = [&](int k) { return Byte(static_cast<double>(sum[k](col, row)) / n); };
        picture(first + col, row) = {mean(0), mean(1), mean(2)};
      }
    }
  }
  return picture;
}

std::vector<Eigen::Vector3f> PointsInSubject(const Surface& surface, const Eigen::Isometry3d& motion,
                                             const Eigen::Matrix3d& subject_from_camera) {
  std::vector<Eigen::Vector3f> points;
  const std::size_t step = std::max<std::size_t>(1, surface.size() / kMostPoints);
  const Eigen::Matrix3f turn = (subject_from_camera * motion.linear()).cast<float>();
  const Eigen::Vector3f shift = (subject_from_camera * motion.translation()).cast<float>();
  for (std::size_t k = 0; k < surface.size(); k += step) {
    points.emplace_back(turn * surface.point_in_camera[k] + shift);
  }
  return points;
}

}  // namespace striae::app
