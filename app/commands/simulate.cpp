// `striae simulate limb|bust`: photographs of bodies with known truth, taken by the virtual rig.
#include <map>

#include "app/command.h"
#include "app/simulation_options.h"
#include "app/simulation_scenes.h"

namespace striae::app {
namespace {

struct LimbCommand {
  rig::LimbOptions limb;
  int visits = 1;
};

void AddLimb(CLI::App& root, Context& context) {
  const auto options = std::make_shared<LimbCommand>();
  CLI::App* command = AddScene(root, context, "limb", "A limb with a wound of exactly known volume, area and depth",
                               "striae simulate limb --out scene --crater-depth 6 --visits 3 --json", "small",
                               [options](Simulation& s) { return SimulateLimb(options->limb, options->visits, s); });
  rig::LimbOptions& limb = options->limb;
  rig::CraterOptions& crater = limb.crater;
  command->add_option("--crater-depth", crater.depth_mm, "Depth, mm")->capture_default_str();
  command->add_option("--crater-radius", crater.radius_mm, "Half width across the limb, mm")->capture_default_str();
  command->add_option("--crater-elongation", crater.elongation, "Length over width")->capture_default_str();
  command->add_option("--crater-wall", crater.wall, "Steepness of the wall, 2 or more")->capture_default_str();
  command->add_option("--limb-radius", limb.radius_mm, "Radius of the limb, mm; 30 is a thin arm")
      ->check(CLI::Range(5.0, 500.0))
      ->capture_default_str();
  command->add_option("--limb-length", limb.length_mm, "Length of the limb, mm")
      ->check(CLI::Range(20.0, 2000.0))
      ->capture_default_str();
  command->add_option("--lean", limb.lean_deg, "In the image, degrees; 90 lies along the stripes")
      ->check(CLI::Range(-180.0, 180.0))
      ->capture_default_str();
  command->add_option("--tip", limb.pitch_deg, "Towards the camera, about its x axis, degrees")
      ->check(CLI::Range(-60.0, 60.0))
      ->capture_default_str();
  command->add_option("--visits", options->visits, "Photographs of the healing wound")->check(CLI::Range(1, 50));
}

struct BustCommand {
  rig::BustOptions bust;
  Eigen::Vector3d head_deg = Eigen::Vector3d::Zero(), torso_deg = Eigen::Vector3d::Zero();  ///< yaw, pitch, roll
  std::vector<double> shift_mm = {0, 0, 0};
};

Status Bust(const BustCommand& command, Simulation& simulation) {
  rig::BustOptions bust = command.bust;
  const Eigen::Vector3d &head = command.head_deg, &torso = command.torso_deg;
  bust.head_rotation = rig::RotationFromPose(head.x(), head.y(), head.z());
  bust.torso_rotation = rig::RotationFromPose(torso.x(), torso.y(), torso.z());
  bust.torso_shift_mm = Eigen::Vector3d(command.shift_mm.data());
  return SimulateBust(bust, head, simulation);
}

void AddBust(CLI::App& root, Context& context) {
  const auto options = std::make_shared<BustCommand>();
  CLI::App* command = AddScene(root, context, "bust", "A bust, neutral and with the head turned by known angles",
                               "striae simulate bust --out scene --yaw 12 --hair long --shirt striped --json", "large",
                               [options](Simulation& s) { return Bust(*options, s); });
  const auto angle = CLI::Range(-60.0, 60.0);
  command->add_option("--yaw", options->head_deg.x(), "Head to the subject's right, degrees")->check(angle);
  command->add_option("--pitch", options->head_deg.y(), "Chin down, degrees")->check(angle);
  command->add_option("--roll", options->head_deg.z(), "Head tilted to the subject's left, degrees")->check(angle);
  command->add_option("--torso-yaw", options->torso_deg.x(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-pitch", options->torso_deg.y(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-roll", options->torso_deg.z(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-shift", options->shift_mm, "The whole body: x y z, mm")->expected(3);
  const std::map<std::string, rig::Shirt> shirts = {{"none", rig::Shirt::kNone},
                                                    {"plain", rig::Shirt::kPlain},
                                                    {"striped", rig::Shirt::kStriped},
                                                    {"dark", rig::Shirt::kDark}};
  command->add_option("--shirt", options->bust.shirt, "none, plain, striped or dark")
      ->transform(CLI::CheckedTransformer(shirts));
  const std::map<std::string, rig::Hair> hair = {
      {"none", rig::Hair::kNone}, {"short", rig::Hair::kShort}, {"long", rig::Hair::kLong}};
  command->add_option("--hair", options->bust.hair, "none, short or long (over the shoulders)")
      ->transform(CLI::CheckedTransformer(hair));
  command->add_flag("--arm", options->bust.arm, "The left forearm held before the chest");
}

}  // namespace

void AddCommand_simulate(CLI::App& root, Context& context) {
  AddLimb(root, context);
  AddBust(root, context);
}

}  // namespace striae::app
