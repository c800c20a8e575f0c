#include "tests/reconstruct/calibration_scene.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "core/optics.h"

namespace striae::reconstruct::testing {

Surface DomedPlate() {
  constexpr int kCols = 151, kRows = 131;
  const Eigen::Vector3d domes[] = {{-90, -70, 40}, {80, -75, 34}, {0, 0, 45}, {-85, 75, 36}, {90, 70, 42}};
  Surface mesh;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const double x = 2 * (col - 75), y = 2 * (row - 65);
      double z = 0;
      for (const auto& dome : domes) {
        const double r2 = (std::pow(x - dome.x(), 2) + std::pow(y - dome.y(), 2)) / (dome.z() * dome.z());
        if (r2 < 1) z = -20 * std::pow(1 - r2, 2);
      }
      mesh.point_in_camera.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
  for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
    for (std::uint32_t col = 0; col + 1 < kCols; ++col) {
      const std::uint32_t i = row * kCols + col;
      mesh.faces.push_back({i, i + kCols, i + 1});
      mesh.faces.push_back({i + 1, i + kCols, i + kCols + 1});
    }
  }
  return mesh;
}

Calibration TrueRig() {
  Calibration rig;
  rig.image_width_px = 4288;
  rig.image_height_px = 2848;
  rig.camera = {9495, 9502, 2128, 1439, -0.04, 0.03, 0, 0};
  rig.projector.center_mm = {3.5, -109, 51};
  rig.projector.rotation_rodrigues = {0.112, 0.004, -0.006};
  rig.projector.focal_stripes = 527;
  rig.projector.center_order = 68.4;
  rig.projector.k1 = -0.02;
  rig.stripes = 140;
  return rig;
}

NominalRig Nominal() {
  NominalRig nominal;
  nominal.image_width_px = 4288;
  nominal.image_height_px = 2848;
  nominal.stripes = 140;
  nominal.first_distance_mm = 900;
  return nominal;
}

CalibrationFit TruePose() {
  CalibrationFit pose;
  pose.camera_from_object =
      (Eigen::AngleAxisd(0.08, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-0.06, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  pose.object_in_camera_mm = {9, -7, 912};
  pose.slide_direction = Eigen::Vector3d(0.015, -0.02, 1).normalized();
  return pose;
}

std::vector<CalibrationView> PhotographPlate(const ReferenceShape& shape, int photographs, double step_mm,
                                             const Calibration& rig, unsigned seed) {
  const StripeOptics optics(rig);
  const CalibrationFit pose = TruePose();
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, kPhaseNoise_stripes);
  std::vector<CalibrationView> views;
  for (int v = 0; v < photographs; ++v) {
    CalibrationView view;
    view.position_mm = step_mm * v;
    const double unknown = 3 - 7.0 * v;  // unwrapping starts each photograph at a whole number of its own
    for (int row = 20; row < rig.image_height_px; row += 44) {
      for (int col = 20; col < rig.image_width_px; col += 44) {
        const Eigen::Vector3d ray = RayOf(rig.camera, {static_cast<double>(col), static_cast<double>(row)});
        const auto depth = pose.ReferenceDepth(shape, ray, view.position_mm, false);
        if (!depth) continue;
        const auto order = optics.OrderAt(*depth * ray);
        if (!order || *order < -0.25 || *order > 139.25) continue;
        view.samples.push_back(
            {{static_cast<double>(col), static_cast<double>(row)}, *order + unknown + noise(engine)});
      }
    }
    view.low_edge_order = -0.52 + unknown;
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace striae::reconstruct::testing
