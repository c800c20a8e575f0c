#include "app/head_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/head_views.h"
#include "app/io/colour_bar.h"
#include "app/io/files.h"
#include "report/drawing.h"
#include "report/picture.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

constexpr Rgb8 kNeutral{70, 120, 215}, kPose{240, 150, 50}, kClay{205, 205, 205}, kInk{40, 40, 40}, kArrow{170, 0, 40};
constexpr double kWorst_mm = 1;   // of the residuals' scale
constexpr double kAxis_mm = 230;  // length of the head's axes
constexpr double kArc_mm = 200;   // radius of an angle's arc

Painted InOneColour(std::vector<Eigen::Vector3f> points, Rgb8 colour) {
  Painted layer;
  layer.colour.assign(points.size(), colour);
  layer.point = std::move(points);
  return layer;
}

/// The neutral capture onto the other one: above the neck with the head, below it with the torso.
std::vector<Eigen::Vector3f> NeutralLaidOn(const Surface& neutral, const head::HeadFits& fits) {
  const auto still = PointsInSubject(neutral, Eigen::Isometry3d::Identity(), fits.subject_from_camera);
  const auto with_head = PointsInSubject(neutral, fits.head.pose_from_neutral, fits.subject_from_camera);
  auto points = PointsInSubject(neutral, fits.torso.pose_from_neutral, fits.subject_from_camera);
  const auto neck = static_cast<float>((fits.subject_from_camera * fits.neck_in_camera).y());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (still[k].y() > neck) points[k] = with_head[k];
  }
  return points;
}

Painted Residuals(const head::HeadFits& fits) {
  Painted layer;
  layer.lit = false;
  const Eigen::Matrix3f turn = fits.subject_from_camera.cast<float>();
  for (const head::FittedPart* part : {&fits.head, &fits.torso}) {
    for (std::size_t k = 0; k < part->point_in_pose.size(); ++k) {
      // 3 mm nearer to every viewer than the clay that it lies on.
      layer.point.emplace_back(turn * part->point_in_pose[k] + Eigen::Vector3f(3, 3, 3));
      layer.colour.push_back(Viridis(std::abs(static_cast<double>(part->residual_mm[k])) / kWorst_mm));
    }
  }
  return layer;
}

/// Dark lines and letters on the picture: multiplied, so that the drawing's white paper vanishes.
void DrawOn(const report::Drawing& drawing, ImageRgb& picture) {
  const ImageRgb ink = report::Rasterise(drawing, 1);
  const auto times = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a * b / 255); };
  for (int row = 0; row < std::min(ink.height(), picture.height()); ++row) {
    for (int col = 0; col < std::min(ink.width(), picture.width()); ++col) {
      Rgb8& p = picture(col, row);
      const Rgb8 q = ink(col, row);
      p = {times(p.r, q.r), times(p.g, q.g), times(p.b, q.b)};
    }
  }
}

report::Drawing Sheet(const Layout& layout, const std::string& title) {
  report::Drawing sheet;
  sheet.width = layout.width();
  sheet.height = layout.height();
  const char* names[] = {"front", "subject's right side", "top"};
  for (std::size_t k = 0; k < kViews.size(); ++k) {
    sheet.Text({layout.Panel(kViews[k])[0] + 4.0, 16}, 12, names[k], kInk);
  }
  sheet.Text({layout.Panel(View::kFront)[0] + 4.0, layout.height() - 7.0}, 12, title, kInk);
  return sheet;
}

/// Where an axis of the head points to in one view, before and after, with the arc between and the angle in words.
void DrawAngle(const Layout& layout, View view, const Eigen::Vector3d& neck, const Eigen::Vector3d& axis,
               const Eigen::Matrix3d& turn, const Measurement& angle, report::Drawing& sheet) {
  const auto at = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d px = layout.PixelOf(view, p);
    return report::Point{px.x(), px.y()};
  };
  const Eigen::Vector3d turned = turn * axis;
  sheet.Line({at(neck), at(neck + kAxis_mm * axis)}, 2, kInk, true);
  sheet.Line({at(neck), at(neck + kAxis_mm * turned)}, 2, kArrow);
  std::vector<report::Point> arc;
  for (int i = 0; i <= 24; ++i) {
    const Eigen::Vector3d between = (1 - i / 24.0) * axis + i / 24.0 * turned;
    if (between.norm() < 1e-6) return;
    arc.push_back(at(neck + kArc_mm * between.normalized()));
  }
  const report::Point end = arc.back(), before = arc[arc.size() - 4];
  const Eigen::Vector2d along(end.x - before.x, end.y - before.y);
  sheet.Line(arc, 2, kArrow);
  if (along.norm() > 1.5) {  // an arrow's head needs a direction
    const Eigen::Vector2d d = 9 * along.normalized(), across(-d.y() / 2, d.x() / 2);
    sheet.Polygon({{end.x, end.y},
                   {end.x - d.x() + across.x(), end.y - d.y() + across.y()},
                   {end.x - d.x() - across.x(), end.y - d.y() - across.y()}},
                  kArrow, kArrow, 0);
  }
  char text[80];
  std::snprintf(text, sizeof text, "%s %.1f +- %.1f deg", angle.name.c_str(), angle.value, angle.uncertainty);
  sheet.Text({layout.Panel(view)[0] + 4.0, 35}, 13, text, kArrow, report::Anchor::kStart, true);
}

ImageRgb Angles(const Surface& neutral, const Surface& pose, const head::HeadFits& fits, const AnalysisReport& report) {
  const auto here = PointsInSubject(neutral, Eigen::Isometry3d::Identity(), fits.subject_from_camera);
  const Eigen::Matrix3d in_camera =
      fits.torso.pose_from_neutral.linear().transpose() * fits.head.pose_from_neutral.linear();
  const Eigen::Matrix3d turn = fits.subject_from_camera * in_camera * fits.subject_from_camera.transpose();
  const Eigen::Vector3d neck = fits.subject_from_camera * fits.neck_in_camera;
  std::vector<Eigen::Vector3d> tips;
  for (const int axis : {0, 1}) {
    tips.emplace_back(neck + kAxis_mm * Eigen::Vector3d::Unit(axis));
    tips.emplace_back(neck + kAxis_mm * turn.col(axis));
  }
  const Layout layout(here, tips);
  ImageRgb picture = PaintViews(
      layout,
      {InOneColour(here, kNeutral),
       InOneColour(PointsInSubject(pose, fits.torso.pose_from_neutral.inverse(), fits.subject_from_camera), kPose)});
  report::Drawing sheet = Sheet(layout, "torsos laid on each other; blue: neutral, orange: the pose");
  const struct {
    const char* name;
    View view;
    Eigen::Vector3d axis;
  } shown[] = {{"tilt", View::kFront, Eigen::Vector3d::UnitY()},
               {"flexion", View::kSide, Eigen::Vector3d::UnitY()},
               {"rotation", View::kTop, Eigen::Vector3d::UnitX()}};
  for (const auto& [name, view, axis] : shown) {
    if (const Measurement* angle = report.Find(name)) DrawAngle(layout, view, neck, axis, turn, *angle, sheet);
  }
  DrawOn(sheet, picture);
  return picture;
}

ImageRgb WithBar(const ImageRgb& picture) {
  ImageRgb wide(picture.width() + static_cast<int>(kBarWidth), picture.height(), Rgb8{255, 255, 255});
  Paste(picture, 0, 0, wide);
  Paste(ColourBar({0, kWorst_mm, "mm", false}, picture.height(), 1), picture.width(), 0, wide);
  return wide;
}

}  // namespace

Result<std::vector<std::string>> WriteHeadPictures(const fs::path& folder, const Surface& neutral, const Surface& pose,
                                                   const head::HeadFits& fits, const AnalysisReport& report) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return Fail(ErrorCode::kIo, "cannot make the folder " + folder.string() + ": " + failed.message());
  const auto still = PointsInSubject(neutral, Eigen::Isometry3d::Identity(), fits.subject_from_camera);
  const auto other = PointsInSubject(pose, Eigen::Isometry3d::Identity(), fits.subject_from_camera);
  auto both = still;
  both.insert(both.end(), other.begin(), other.end());
  const Layout layout(both);
  const auto overlay = [&](const std::vector<Eigen::Vector3f>& moved, const std::string& title) {
    ImageRgb picture = PaintViews(layout, {InOneColour(moved, kNeutral), InOneColour(other, kPose)});
    DrawOn(Sheet(layout, title), picture);
    return picture;
  };
  ImageRgb clay = PaintViews(layout, {InOneColour(other, kClay)});
  const ImageRgb residuals = PaintViews(layout, {Residuals(fits)});
  for (std::size_t p = 0; p < clay.size(); ++p) {
    const Rgb8 q = residuals.pixels()[p];
    if (!(q == Rgb8{255, 255, 255})) clay.pixels()[p] = q;
  }
  DrawOn(Sheet(layout, "distance of the neutral head and torso from the other capture"), clay);
  const std::pair<const char*, ImageRgb> pictures[] = {
      {"before.png", overlay(still, "as photographed; blue: neutral, orange: the pose")},
      {"after.png", overlay(NeutralLaidOn(neutral, fits), "head and torso each laid on the pose; blue: neutral")},
      {"residuals.png", WithBar(clay)},
      {"angles.png", Angles(neutral, pose, fits, report)}};
  std::vector<std::string> written;
  for (const auto& [name, picture] : pictures) {
    const auto bytes = report::EncodePng(picture);
    if (!bytes) return Fail(bytes.error());
    if (Status done = WriteFile(folder / name, *bytes); !done) return Fail(done.error());
    written.push_back((folder / name).string());
  }
  return written;
}

}  // namespace striae::app
