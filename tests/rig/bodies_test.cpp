// The rig's bodies have the volumes, areas and rotations that they claim.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "acquire/rig/bust.h"
#include "acquire/rig/limb.h"
#include "acquire/rig/plane.h"

namespace striae::rig {
namespace {

/// Six times the volume between a mesh and the origin; differences of meshes with the same rim are volumes.
double SixfoldVolume_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  const Eigen::Vector3d origin(0, 0, 1050);  // near the limb, so that little cancels
  for (const auto& t : mesh.triangle) {
    sum += (mesh.vertex[t[0]] - origin).dot((mesh.vertex[t[1]] - origin).cross(mesh.vertex[t[2]] - origin));
  }
  return sum;
}

TEST(Limb, CraterVolumeIsTheIntegralOfItsDefinition) {
  for (const double depth : {2.0, 8.0}) {
    LimbOptions options;
    options.crater.depth_mm = depth;
    const auto limb = MakeLimb(options);
    ASSERT_TRUE(limb) << limb.error().Describe();
    // On a plain grid of angle and height, unlike the polar rule of the truth.
    double volume = 0;
    constexpr double kAngle = 5e-4, kAlong = 0.05;
    for (double angle = -0.8; angle < 0.8; angle += kAngle) {
      for (double along = -45; along < 60; along += kAlong) {
        const double outer = LimbRadius(options, angle, along), inner = outer - CraterDepth(options, angle, along);
        volume += (outer * outer - inner * inner) / 2 * kAngle * kAlong;
      }
    }
    // Both rules are good to 1e-5 or better on this smooth integrand.
    EXPECT_NEAR(limb->truth.volume_ml, volume / 1000, 1e-4 * volume / 1000);
  }
}

TEST(Limb, TheMeshHasTheCratersVolume) {
  LimbOptions carved, whole;
  whole.crater.depth_mm = 0;
  const auto with = MakeLimb(carved), without = MakeLimb(whole);
  ASSERT_TRUE(with && without);
  const double volume_ml = std::abs(SixfoldVolume_mm3(with->mesh) - SixfoldVolume_mm3(without->mesh)) / 6000;
  // Facets of 0.2 mm against curvatures of up to 2 / mm at the rim: well below one part in a thousand.
  EXPECT_NEAR(volume_ml, with->truth.volume_ml, 1e-3 * volume_ml);
}

TEST(Limb, AreasAndDepthAreThoseOfAWoundOfThatSize) {
  LimbOptions options;
  options.crater.irregularity = 0;
  const auto limb = MakeLimb(options);
  ASSERT_TRUE(limb);
  const CraterOptions& c = options.crater;
  // Skin area: an ellipse wrapped around the limb; taper and ovality change it by up to 2 %.
  const double ellipse_cm2 = std::numbers::pi * c.radius_mm * c.radius_mm * c.elongation / 100;
  EXPECT_NEAR(limb->truth.skin_area_cm2, ellipse_cm2, 0.02 * ellipse_cm2);
  EXPECT_GT(limb->truth.bed_area_cm2, limb->truth.skin_area_cm2);
  // The radius leans against the skin's normal by the taper, 5 degrees: 1 - cos = 0.4 %.
  EXPECT_NEAR(limb->truth.max_depth_mm, c.depth_mm, 0.006 * c.depth_mm);
}

TEST(Limb, TheOutlineLiesOnTheHealthySkin) {
  const auto limb = MakeLimb({});
  ASSERT_TRUE(limb);
  for (const Eigen::Vector3d& point : limb->truth.outline_in_camera) {
    double nearest = 1e9;
    for (const Eigen::Vector3d& v : limb->mesh.vertex) nearest = std::min(nearest, (v - point).squaredNorm());
    EXPECT_LT(std::sqrt(nearest), 0.2);  // vertices there are 0.2 mm apart: half a diagonal is 0.15
  }
}

TEST(Limb, RefusesAWoundThatDoesNotFit) {
  LimbOptions wide;
  wide.crater.radius_mm = 90;
  EXPECT_EQ(MakeLimb(wide).error().code, ErrorCode::kUsage);
  LimbOptions deep;
  deep.crater.depth_mm = 50;
  EXPECT_EQ(MakeLimb(deep).error().code, ErrorCode::kUsage);
  LimbOptions nonsense;
  nonsense.crater.along_mm = std::nan("");
  EXPECT_EQ(MakeLimb(nonsense).error().code, ErrorCode::kUsage);
}

TEST(Limb, NormalsPointOutOfTheBody) {
  const auto limb = MakeLimb({});
  ASSERT_TRUE(limb);
  int towards_camera = 0, away = 0;
  for (std::size_t i = 0; i < limb->mesh.vertex.size(); ++i) {
    if (limb->mesh.vertex[i].z() > 1020) continue;  // the near side only
    (limb->mesh.normal[i].z() < 0 ? towards_camera : away)++;
  }
  EXPECT_GT(towards_camera, 1000);
  EXPECT_EQ(away, 0);
}

TEST(Pose, SignsAreTheSubjects) {
  // A face looks along -z; x runs to the subject's left, y down.
  const Eigen::Vector3d gaze(0, 0, -1), crown(0, -1, 0);
  EXPECT_LT((RotationFromPose(20, 0, 0) * gaze).x(), 0) << "positive yaw looks to the subject's right";
  EXPECT_GT((RotationFromPose(0, 20, 0) * gaze).y(), 0) << "positive pitch lowers the chin";
  EXPECT_GT((RotationFromPose(0, 0, 20) * crown).x(), 0) << "positive roll tilts to the subject's left";
}

TEST(Bust, HeadAndTorsoMoveRigidlyByTheStatedRotations) {
  BustOptions posed;
  posed.head_rotation = RotationFromPose(14, -6, 5);
  posed.torso_rotation = RotationFromPose(3, 1, -2);
  posed.torso_shift_mm = {6, -4, 9};
  const TriangleMesh neutral = MakeBust({}), moved = MakeBust(posed);
  ASSERT_EQ(neutral.vertex.size(), moved.vertex.size());
  const Eigen::Vector3d pivot(0, posed.pivot_y_mm, posed.distance_mm);
  const Eigen::Matrix3d head = posed.torso_rotation * posed.head_rotation;
  int head_points = 0, torso_points = 0;
  for (std::size_t i = 0; i < neutral.vertex.size(); ++i) {
    const Eigen::Vector3d from_pivot = neutral.vertex[i] - pivot;
    const Eigen::Vector3d to = moved.vertex[i] - pivot - posed.torso_shift_mm;
    if (from_pivot.y() < -100) {
      EXPECT_LT((to - head * from_pivot).norm(), 1e-9);
      ++head_points;
    } else if (from_pivot.y() > 60) {
      EXPECT_LT((to - posed.torso_rotation * from_pivot).norm(), 1e-9);
      ++torso_points;
    }
  }
  EXPECT_GT(head_points, 10000);
  EXPECT_GT(torso_points, 10000);
}

TEST(Bust, FacetsDoNotShowAtTwoMetres) {
  const TriangleMesh bust = MakeBust({});
  int fine = 0, coarse = 0;
  for (const auto& t : bust.triangle) {
    const Eigen::Vector3d& a = bust.vertex[t[0]];
    if (a.z() > 1990 || a.y() > 300) continue;  // what the camera sees
    for (const std::uint32_t other : {t[1], t[2]}) {
      // How far an arc of that length and turn rises above its chord.
      const double rise = (bust.vertex[other] - a).norm() * (bust.normal[other] - bust.normal[t[0]]).norm() / 8;
      (rise < 0.02 ? fine : coarse)++;
    }
  }
  // A tenth of a pixel, which is 0.21 mm wide at 2 m; creases (nostrils, ears) may be a little coarser.
  EXPECT_LT(coarse, 0.005 * fine);
}

TEST(ReferencePlate, CapsStandTowardsTheCamera) {
  const ReferencePlateOptions options;
  const TriangleMesh plate = MakeReferencePlate(options);
  double highest = 0, lowest = 0;
  for (const Eigen::Vector3d& v : plate.vertex) {
    highest = std::min(highest, v.z());
    lowest = std::max(lowest, v.z());
  }
  EXPECT_NEAR(highest, -options.cap_height_mm, 0.02);  // a vertex lies within 0.7 mm of each summit of radius 30 mm
  EXPECT_EQ(lowest, 0);
}

}  // namespace
}  // namespace striae::rig
