#include "tests/reconstruct/scenes_kinds.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace striae::testing {
namespace {

using Eigen::Vector3d;
using Kind = Body::Kind;

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed * 2654435761U + 17) {}
  double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }

 private:
  std::mt19937 engine_;
};

Eigen::Matrix3d Turned(double yaw_deg, double pitch_deg, double roll_deg) {
  constexpr double kRad = std::numbers::pi / 180;
  return (Eigen::AngleAxisd(roll_deg * kRad, Vector3d::UnitZ()) * Eigen::AngleAxisd(yaw_deg * kRad, Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_deg * kRad, Vector3d::UnitX()))
      .toRotationMatrix();
}

/// A rig near the nominal one, its grating's middle aimed at the axis at the middle distance.
Calibration SomeRig(bool small, double sensor, Dice& dice) {
  Calibration rig;
  rig.image_width_px = static_cast<int>(4288 * sensor);
  rig.image_height_px = static_cast<int>(2848 * sensor);
  const double focal = (small ? 9560 : 9320) * sensor * dice(0.98, 1.02);
  rig.camera = {focal,
                focal * dice(0.999, 1.001),
                (2143.5 + dice(-40, 40)) * sensor,
                (1423.5 + dice(-40, 40)) * sensor,
                dice(-0.06, 0.0),
                dice(0.0, 0.05),
                dice(-2e-4, 2e-4),
                dice(-2e-4, 2e-4)};
  const double distance = small ? 1000 : 2000;
  rig.projector.center_mm = {dice(-8, 8), dice(-130, -100), dice(30, 60)};
  const double down = std::atan2(-rig.projector.center_mm.y(), distance - rig.projector.center_mm.z());
  rig.projector.rotation_rodrigues = {down + dice(-0.004, 0.004), dice(-0.006, 0.006), dice(-0.008, 0.008)};
  rig.projector.focal_stripes = (small ? 521 : 258) * dice(0.97, 1.03);
  rig.projector.k1 = dice(-0.03, 0.0);
  rig.stripes = small ? 140 : 67;
  if (small && sensor < 0.4) {  // a coarse sensor cannot resolve 140 stripes: half as many, twice as wide
    rig.projector.focal_stripes /= 2;
    rig.stripes = 70;
  }
  rig.projector.center_order = (*rig.stripes - 1) / 2.0 + dice(-2, 2);
  rig.near_mm = small ? 900 : 1800;
  rig.far_mm = small ? 1100 : 2200;
  return rig;
}

struct Draft {
  BodyScene scene;
  double middle_mm;
  Dice dice;
  Body& Add(Kind kind, const Vector3d& center, const Vector3d& half, const Eigen::Matrix3d& turned) {
    scene.bodies.push_back(Placed(kind, center, half, turned));
    return scene.bodies.back();
  }
  Body& Add(Kind kind, const Vector3d& center, const Vector3d& half) {
    return Add(kind, center, half, Eigen::Matrix3d::Identity());
  }
};

std::function<double(const Vector3d&)> Even(double albedo) {
  return [albedo](const Vector3d&) { return albedo; };
}

/// Dark hair: strands of changing brightness, no more than a few percent.
double Hair(const Vector3d& p) {
  return 0.025 + 0.02 * std::sin(90 * p.x() + 7 * p.y()) * std::sin(37 * p.x() - 11 * p.z());
}

/// Head (skin below the hairline), neck and torso about the middle of the picture; the torso's albedo is `shirt`.
void Bust(Draft& d, const std::function<double(const Vector3d&)>& shirt) {
  const double z = d.middle_mm + d.dice(-80, 80), x = d.dice(-60, 60), y = d.dice(-40, 20), yaw = d.dice(-30, 30);
  const double hairline = d.dice(-0.9, -0.5);
  d.Add(Kind::kBall, {x, y - 110, z + 20}, {78, 115, 100}, Turned(yaw, d.dice(-15, 15), d.dice(-10, 10))).albedo =
      [hairline](const Vector3d& p) { return p.y() < hairline ? Hair(p) : 0.55; };
  d.Add(Kind::kBall, {x + 1.2 * yaw, y - 100, z - 82}, {14, 22, 20}).albedo = Even(0.55);  // nose
  d.Add(Kind::kTube, {x, y + 10, z + 40}, {58, 90, 58}).albedo = Even(0.5);
  d.Add(Kind::kBall, {x, y + 330, z + 60}, {230, 290, 130}, Turned(d.dice(-10, 10), d.dice(-8, 8), 0)).albedo = shirt;
}

void Head(Draft& d) { Bust(d, Even(0.5)); }

void StripedShirt(Draft& d) {
  const double period = d.dice(0.03, 0.3), dark = d.dice(0.02, 0.2), phase = d.dice(0, 6);
  Bust(d, [=](const Vector3d& p) { return std::sin(2 * std::numbers::pi * p.y() / period + phase) > 0 ? 0.6 : dark; });
}

void DarkGarment(Draft& d) {
  // A straight edge square to the picture's columns: dark trousers, or a dark collar and shirt.
  const double edge = d.dice(-0.9, 0.2), dark = d.dice(0.01, 0.08);
  const bool below = d.dice(0, 1) > 0.5;
  const double y = d.dice(-100, 100);
  d.Add(Kind::kTube, {d.dice(-40, 40), y, d.middle_mm + 120 + d.dice(-60, 60)}, {200, 600, 120}).albedo =
      [=](const Vector3d& p) { return (p.y() * 600 + y > edge * 150) == below ? dark : 0.55; };
}

void Limb(Draft& d) {
  const double r = d.dice(35, 60);
  d.Add(Kind::kTube, {d.dice(-30, 30), 0, d.middle_mm + r + d.dice(-60, 60)}, {r, 300, r * d.dice(0.8, 1)},
        Turned(d.dice(-8, 8), d.dice(-6, 6), d.dice(-10, 10)));
}

void ThinLimb(Draft& d) {
  // Across the picture: only its rounded sides show along the columns, never an end of the stripes.
  const double r = d.dice(18, 35);
  d.Add(Kind::kTube, {0, d.dice(-40, 40), d.middle_mm + r + d.dice(-60, 60)}, {r, 260, r},
        Turned(d.dice(-8, 8), 0, 90 + d.dice(-6, 6)));
}

void ArmBeforeBody(Draft& d) {
  const double z = d.middle_mm + d.dice(40, 140), r = d.dice(35, 50);
  d.Add(Kind::kBall, {d.dice(-40, 40), d.dice(-50, 50), z + 100}, {220, 420, 100});
  d.Add(Kind::kTube, {d.dice(-60, 60), d.dice(-60, 120), z - d.dice(60, 180)}, {r, 260, r},
        Turned(0, 0, 90 + d.dice(-25, 25)));
}

void DarkBar(Draft& d) {
  // A black bar, level with the stripes, before a body: its shadow's border is straight and the body goes on.
  const double z = d.middle_mm + d.dice(0, 100), half = d.dice(8, 20), before = d.dice(60, 180);
  d.Add(Kind::kTube, {0, 0, z + 150}, {d.dice(120, 200), 500, 150}).albedo = Even(0.55);
  d.Add(Kind::kSquare, {0, d.dice(-90, 60), z - before}, {500, half, 1}, Turned(0, 0, d.dice(-1, 1))).albedo =
      Even(d.dice(0.005, 0.03));
}

void PlateBeforeWall(Draft& d) {
  // All of the plate inside of the field, its sides level with the stripes; a wall behind that the room lights.
  d.Add(Kind::kSquare, {d.dice(-20, 20), d.dice(-40, 40), d.middle_mm + d.dice(-60, 60)},
        {d.dice(60, 120), d.dice(45, 95), 1}, Turned(d.dice(-10, 10), 0, 0));
  d.Add(Kind::kSquare, {0, 0, d.middle_mm * d.dice(1.2, 2.5)}, {5000, 5000, 1}).albedo = Even(d.dice(0.2, 0.8));
}

void ReferencePlate(Draft& d) {
  d.Add(Kind::kSquare, {0, 0, d.middle_mm + d.dice(-80, 80)}, {300, 300, 1}, Turned(d.dice(-8, 8), d.dice(-8, 8), 0));
  for (int i = 0; i < 6; ++i) {
    d.Add(Kind::kBall, {-75.0 + 75 * (i % 3), -35.0 + 70 * static_cast<double>(i / 3), d.middle_mm + 10},
          {20, 20, d.dice(5, 40)});
  }
}

void SmallBall(Draft& d) {
  const double r = d.dice(40, 70);
  d.Add(Kind::kBall, {d.dice(-40, 40), d.dice(-30, 30), d.middle_mm + r + d.dice(-60, 60)}, {r, r, r});
}

void TwoLimbs(Draft& d) {
  // The second one beside the first and at another depth: nothing joins them.
  for (const double side : {-1.0, 1.0}) {
    const double r = d.dice(28, 45), half = side < 0 ? 300 : d.dice(40, 300);
    d.Add(Kind::kTube, {side * d.dice(55, 80), d.dice(-10, 10), d.middle_mm + r + d.dice(-60, 60)}, {r, half, r},
          Turned(0, d.dice(-5, 5), d.dice(-4, 4)));
  }
}

void Steps(Draft& d) {
  // Plates behind one another: their sides are straight and the depths unrelated.
  double z = d.middle_mm + 80;
  d.Add(Kind::kSquare, {0, 0, z}, {400, 400, 1});
  for (int i = 0; i < 3; ++i) {
    z -= d.dice(10, 60);
    d.Add(Kind::kSquare, {d.dice(-60, 60), d.dice(-50, 50), z}, {d.dice(25, 60), d.dice(20, 45), 1});
  }
}

struct Recipe {
  void (*build)(Draft&);
  bool small;
};

const std::map<std::string, Recipe>& Recipes() {
  static const std::map<std::string, Recipe> recipes = {{"head over torso", {Head, false}},
                                                        {"striped shirt", {StripedShirt, false}},
                                                        {"dark garment", {DarkGarment, false}},
                                                        {"arm before body", {ArmBeforeBody, false}},
                                                        {"dark bar", {DarkBar, false}},
                                                        {"limb", {Limb, true}},
                                                        {"thin limb", {ThinLimb, true}},
                                                        {"plate before wall", {PlateBeforeWall, true}},
                                                        {"reference plate", {ReferencePlate, true}},
                                                        {"small ball", {SmallBall, true}},
                                                        {"two limbs", {TwoLimbs, true}},
                                                        {"steps", {Steps, true}},
                                                        {"garment, near", {DarkGarment, true}},
                                                        {"bar, near", {DarkBar, true}}};
  return recipes;
}

}  // namespace

const std::vector<std::string>& OrderSceneKinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> names;
    for (const auto& [name, recipe] : Recipes()) names.push_back(name);
    return names;
  }();
  return kinds;
}

OrderScene MakeOrderScene(const std::string& kind, std::uint32_t seed, double sensor) {
  const Recipe& recipe = Recipes().at(kind);
  Dice dice(seed + static_cast<std::uint32_t>(kind.size()) * 977U);
  BodyScene scene;
  scene.rig = SomeRig(recipe.small, sensor, dice);
  scene.flash = dice(0.6, 1.1);
  scene.ambient = dice(0.008, 0.05);
  scene.leak = dice(0.0, 0.03);
  scene.softness = dice(0.06, 0.16);
  scene.noise = dice(0.002, 0.006);
  scene.seed = seed;
  Draft draft{std::move(scene), recipe.small ? 1000.0 : 2000.0, dice};
  recipe.build(draft);
  const double half_range = (draft.scene.rig.far_mm - draft.scene.rig.near_mm) / 2;
  const double told = draft.middle_mm + draft.dice(-1, 1) * half_range;
  return {kind, std::move(draft.scene), told};
}

}  // namespace striae::testing
