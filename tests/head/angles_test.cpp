#include "analysis/head/angles.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace striae::head {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kForward = Vector3d::UnitX(), kUp = Vector3d::UnitY(), kRight = Vector3d::UnitZ();

HeadAngles Degrees(double rotation, double flexion, double tilt) {
  return {Angle::Degrees(rotation), Angle::Degrees(flexion), Angle::Degrees(tilt), {}};
}

TEST(HeadAngles, PositiveRotationTurnsTheNoseToTheSubjectsLeft) {
  const Vector3d nose = Compose(Degrees(30, 0, 0)) * kForward;
  EXPECT_NEAR(nose.dot(-kRight), 0.5, 1e-12);  // sin 30 deg
  EXPECT_NEAR(nose.dot(kUp), 0, 1e-12);
}

TEST(HeadAngles, PositiveFlexionBringsTheChinToTheChest) {
  const Vector3d nose = Compose(Degrees(0, 30, 0)) * kForward;
  EXPECT_NEAR(nose.dot(kUp), -0.5, 1e-12);
  EXPECT_NEAR(nose.dot(kRight), 0, 1e-12);
}

TEST(HeadAngles, PositiveTiltLeansTheCrownToTheSubjectsRight) {
  const Vector3d crown = Compose(Degrees(0, 0, 30)) * kUp;
  EXPECT_NEAR(crown.dot(kRight), 0.5, 1e-12);
  EXPECT_NEAR(crown.dot(kForward), 0, 1e-12);
}

TEST(HeadAngles, SubjectAxesSeenByALevelCamera) {
  // The subject faces the camera: forward is towards it, up is against its y, right is towards its left border.
  Matrix3d expected;
  expected << 0, 0, -1, 0, -1, 0, -1, 0, 0;
  EXPECT_TRUE(SubjectFromCamera({0, -1, 0}).isApprox(expected, 1e-15));
}

TEST(HeadAngles, AnUprightCameraTurnedOnItsSideSeesTheSameRightHandedAxes) {
  const Matrix3d m = SubjectFromCamera({1, 0, 0});
  EXPECT_TRUE((m * Vector3d(1, 0, 0)).isApprox(kUp, 1e-15));
  EXPECT_TRUE((m * Vector3d(0, 0, -1)).isApprox(kForward, 1e-15));
  EXPECT_NEAR(m.determinant(), 1, 1e-15);
}

TEST(HeadAngles, UpAlongTheOpticalAxisIsAProgrammersError) {
  EXPECT_THROW(SubjectFromCamera({0, 0, 1}), std::logic_error);
}

TEST(HeadAngles, DecomposeUndoesCompose) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-170, 170), tilt(-79, 79);
  for (int i = 0; i < 500; ++i) {
    const HeadAngles in = Degrees(any(random), any(random), tilt(random));
    const HeadAngles out = Decompose(Compose(in));
    // Rounding only; the sequence amplifies it by 1 / cos 79 deg = 5.
    EXPECT_NEAR(out.rotation.deg(), in.rotation.deg(), 1e-9);
    EXPECT_NEAR(out.flexion.deg(), in.flexion.deg(), 1e-9);
    EXPECT_NEAR(out.tilt.deg(), in.tilt.deg(), 1e-9);
  }
}

TEST(HeadAngles, ComposeUndoesDecomposeForAnyRotation) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    const Matrix3d r = q.normalized().toRotationMatrix();
    EXPECT_TRUE(Compose(Decompose(r)).isApprox(r, 1e-9));
  }
}

TEST(HeadAngles, TotalAngleIsTheRotationsOwnWhateverTheAxis) {
  const Matrix3d r = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  EXPECT_NEAR(Decompose(r).total.rad(), 0.7, 1e-12);
  EXPECT_NEAR(Decompose(r.transpose()).total.rad(), 0.7, 1e-12);
  EXPECT_NEAR(Decompose(Matrix3d::Identity()).total.rad(), 0, 1e-12);
}

TEST(HeadAngles, SubtractingAnglesIsNotTheRelativeRotation) {
  // Torso (5, 10, 30), head (15, 20, 60): the notes of the field put the error of subtraction at up to 5.9 deg.
  const Matrix3d torso = Compose(Degrees(5, 10, 30)), head = Compose(Degrees(15, 20, 60));
  const HeadAngles relative = Decompose(torso.transpose() * head);
  const double worst = std::max({std::abs(relative.rotation.deg() - 10), std::abs(relative.flexion.deg() - 10),
                                 std::abs(relative.tilt.deg() - 30)});
  EXPECT_GT(worst, 2);
}

TEST(HeadAngles, Words) {
  EXPECT_EQ(InWords("rotation", 32.04), "turned 32.0 deg to the subject's left");
  EXPECT_EQ(InWords("rotation", -15), "turned 15.0 deg to the subject's right");
  EXPECT_EQ(InWords("tilt", 5), "tilted 5.0 deg to the subject's right");
  EXPECT_EQ(InWords("tilt", -5), "tilted 5.0 deg to the subject's left");
  EXPECT_EQ(InWords("flexion", 5), "bent 5.0 deg forward (chin towards the chest)");
  EXPECT_EQ(InWords("flexion", -5), "bent 5.0 deg backward (chin up)");
  EXPECT_EQ(InWords("tilt", -0.01), "not tilted");
  EXPECT_EQ(InWords("total_angle", 16), "turned 16.0 deg in all");
}

}  // namespace
}  // namespace striae::head
