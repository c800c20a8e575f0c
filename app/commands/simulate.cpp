// `striae simulate`: photographs of bodies with known truth, taken by the virtual rig.
#include <fmt/format.h>

#include "app/command.h"
#include "app/simulation.h"

namespace striae::app {
namespace {

struct Options {
  SimulationOptions common;
  rig::LimbOptions limb;
  rig::BustOptions bust;
  rig::PlaneOptions plane;
  Eigen::Vector3d head_deg = Eigen::Vector3d::Zero(), torso_deg = Eigen::Vector3d::Zero();  ///< yaw, pitch, roll
  std::vector<double> shift_mm = {0, 0, 0};
  int visits = 1, steps = 9;
  double step_mm = 25;
  bool no_noise = false;
};

using Scene = std::function<Status(Options&, Simulation&)>;

Status Simulate(Context& context, Options& options, const std::string& name, const Scene& scene) {
  options.common.render.sensor.noise = !options.no_noise;
  options.limb.seed = options.bust.seed = static_cast<unsigned>(options.common.render.sensor.seed);
  auto simulation = Simulation::Prepare(options.common);
  if (!simulation) return Fail(simulation.error());
  if (Status done = scene(options, *simulation); !done) return done;
  const auto document = simulation->Finish(name);
  if (!document) return Fail(document.error());
  std::string text;
  for (const auto& file : (*document)["files"]) text += (text.empty() ? "" : "\n") + file.get<std::string>();
  context.Output(*document, text);
  return {};
}

void AddCommon(CLI::App& command, Options& options, const char* range) {
  SimulationOptions& c = options.common;
  c.range = range;
  c.taken = "2026:01:05 10:00:00";
  c.serial = "3990001";
  command.add_option("--out", c.out, "Folder for the photographs and their truth")->required();
  command.add_option("--range", c.range, "Measuring range: small (1 m) or large (2 m)")
      ->check(CLI::IsMember({"small", "large"}))
      ->capture_default_str();
  command.add_option("--rig", c.rig_file, "True rig as a calibration file instead of the range's own");
  command.add_option("--distance-mm", c.distance_mm, "Distance of the body instead of the rig's")
      ->check(CLI::Range(100.0, 10000.0));
  command.add_option("--scale", c.scale, "Pixels a side relative to the D90's sensor, 0.05 to 1")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  command.add_option("--seed", c.render.sensor.seed, "Of noise and mottling; the same seed gives the same bytes")
      ->capture_default_str();
  command.add_option("--iso", c.render.sensor.iso, "Sensor speed, sets the noise")->check(CLI::Range(100, 6400));
  command.add_flag("--no-noise", options.no_noise, "Leave out shot and read noise");
  command.add_option("--quality", c.quality, "JPEG quality")->check(CLI::Range(1, 100))->capture_default_str();
  command.add_option("--orientation", c.orientation, "EXIF Orientation to write")->check(CLI::Range(1, 8));
  command.add_option("--taken", c.taken, "EXIF time, \"YYYY:MM:DD hh:mm:ss\"")->capture_default_str();
  command.add_option("--serial", c.serial, "Camera serial number in the MakerNote")->capture_default_str();
  command.add_option("--threads", c.render.threads, "Changes the time only")->check(CLI::Range(1, 64));
}

CLI::App* AddScene(CLI::App& group, Context& context, const std::string& name, const std::string& description,
                   const std::string& example, const std::shared_ptr<Options>& options, const char* range,
                   Scene scene) {
  CLI::App* command = AddCommand(group, context, name, description, example);
  AddCommon(*command, *options, range);
  OnRun(command, context,
        [options, name, scene = std::move(scene)](Context& run) { return Simulate(run, *options, name, scene); });
  return command;
}

void AddLimb(CLI::App& group, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = AddScene(group, context, "limb", "A limb with a wound of exactly known volume, area and depth",
                               "striae simulate limb --out scene --crater-depth 6 --visits 3 --json", options, "small",
                               [](Options& o, Simulation& s) { return SimulateLimb(o.limb, o.visits, s); });
  rig::CraterOptions& crater = options->limb.crater;
  command->add_option("--crater-depth", crater.depth_mm, "Depth, mm")->capture_default_str();
  command->add_option("--crater-radius", crater.radius_mm, "Half width across the limb, mm")->capture_default_str();
  command->add_option("--crater-elongation", crater.elongation, "Length over width")->capture_default_str();
  command->add_option("--crater-wall", crater.wall, "Steepness of the wall, 2 or more")->capture_default_str();
  command->add_option("--limb-radius", options->limb.radius_mm, "Radius of the limb, mm")->capture_default_str();
  command->add_option("--visits", options->visits, "Photographs of the healing wound")->check(CLI::Range(1, 50));
}

void AddBust(CLI::App& group, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = AddScene(
      group, context, "bust", "A bust, neutral and with the head turned by known angles",
      "striae simulate bust --out scene --yaw 12 --pitch -5 --json", options, "large", [](Options& o, Simulation& s) {
        o.bust.head_rotation = rig::RotationFromPose(o.head_deg.x(), o.head_deg.y(), o.head_deg.z());
        o.bust.torso_rotation = rig::RotationFromPose(o.torso_deg.x(), o.torso_deg.y(), o.torso_deg.z());
        o.bust.torso_shift_mm = Eigen::Vector3d(o.shift_mm[0], o.shift_mm[1], o.shift_mm[2]);
        return SimulateBust(o.bust, o.head_deg, s);
      });
  const auto angle = CLI::Range(-60.0, 60.0);
  command->add_option("--yaw", options->head_deg.x(), "Head to the subject's right, degrees")->check(angle);
  command->add_option("--pitch", options->head_deg.y(), "Chin down, degrees")->check(angle);
  command->add_option("--roll", options->head_deg.z(), "Head tilted to the subject's left, degrees")->check(angle);
  command->add_option("--torso-yaw", options->torso_deg.x(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-pitch", options->torso_deg.y(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-roll", options->torso_deg.z(), "The whole body, degrees")->check(angle);
  command->add_option("--torso-shift", options->shift_mm, "The whole body: x y z, mm")->expected(3);
}

}  // namespace

void AddCommand_simulate(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "simulate", "Photograph bodies of known shape with the virtual rig");
  AddLimb(group, context);
  AddBust(group, context);
  auto plane = std::make_shared<Options>();
  CLI::App* command = AddScene(group, context, "plane", "A flat plate", "striae simulate plane --out scene --tilt-y 10",
                               plane, "small", [](Options& o, Simulation& s) { return SimulatePlane(o.plane, s); });
  command->add_option("--tilt-x", plane->plane.tilt_x_deg, "About the camera's x axis, degrees");
  command->add_option("--tilt-y", plane->plane.tilt_y_deg, "About the camera's y axis, degrees");
  auto steps = std::make_shared<Options>();
  command = AddScene(group, context, "steps", "The reference plate on a slide, for calibration",
                     "striae simulate steps --out scene --steps 9 --step-mm 25", steps, "small",
                     [](Options& o, Simulation& s) { return SimulateSteps(o.steps, o.step_mm, s); });
  command->add_option("--steps", steps->steps, "Photographs")->check(CLI::Range(2, 50))->capture_default_str();
  command->add_option("--step-mm", steps->step_mm, "Between photographs")->capture_default_str();
}

}  // namespace striae::app
