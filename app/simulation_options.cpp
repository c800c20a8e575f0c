#include "app/simulation_options.h"

#include <cmath>
#include <sstream>

namespace striae::app {
namespace {

Result<rig::LabelOptions> ParseLabel(const std::string& text) {
  rig::LabelOptions label;
  std::istringstream in(text);
  char first = 0, second = 0, third = 0;
  in >> label.id >> first >> label.side_mm >> second >> label.x_mm >> third >> label.y_mm;
  if (!in || first != ',' || second != ',' || third != ',' || !(in >> std::ws).eof()) {
    return Fail(ErrorCode::kUsage,
                "--label " + text + ": give ID,SIDE,X,Y: the marker's number, its side in mm and its place in mm");
  }
  return label;
}

/// What the options say together.
Result<SimulationOptions> Combine(const SceneOptions& options) {
  SimulationOptions common = options.common;
  common.render.sensor.noise = !options.no_noise;
  for (const std::string& text : options.labels) {
    const auto label = ParseLabel(text);
    if (!label) return Fail(label.error());
    common.labels.push_back(*label);
  }
  const double seconds = options.exposure_ms / 1000;
  common.render.motion_mm = seconds * Eigen::Vector3d(options.velocity_mm_s.data());
  return common;
}

Status Simulate(Context& context, const SceneOptions& options, const std::string& name, const Scene& scene) {
  const auto common = Combine(options);
  if (!common) return Fail(common.error());
  auto simulation = Simulation::Prepare(*common);
  if (!simulation) return Fail(simulation.error());
  if (options.motion_px[0] != 0 || options.motion_px[1] != 0) {
    simulation->MoveByPixels({options.motion_px[0], options.motion_px[1]});
  }
  if (Status done = scene(*simulation); !done) return done;
  const auto document = simulation->Finish(name);
  if (!document) return Fail(document.error());
  std::string text;
  for (const auto& file : (*document)["files"]) text += (text.empty() ? "" : "\n") + file.get<std::string>();
  context.Output(*document, text);
  return {};
}

void AddRig(CLI::App& command, SceneOptions& options, const char* range) {
  SimulationOptions& c = options.common;
  c.range = range;
  command.add_option("--out", c.out, "Folder for the photographs and their truth")->required();
  command.add_option("--range", c.range, "Measuring range: small (1 m) or large (2 m)")
      ->check(CLI::IsMember({"small", "large"}))
      ->capture_default_str();
  command.add_option("--rig", c.rig_file, "True rig as a calibration file instead of the range's own");
  command.add_option("--distance-mm", c.distance_mm, "Distance of the body instead of the rig's")
      ->check(CLI::Range(100.0, 10000.0));
  command.add_option("--focus-mm", c.focus_mm, "Where both lenses are focused instead of the rig's distance")
      ->check(CLI::Range(100.0, 10000.0));
  command.add_flag("--sharp", c.sharp, "No defocus before and behind that distance");
  command.add_option("--scale", c.scale, "Pixels a side relative to the D90's sensor, 0.05 to 1")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
}

void AddLightAndSensor(CLI::App& command, SceneOptions& options) {
  SimulationOptions& c = options.common;
  command.add_option("--seed", c.render.sensor.seed, "Of noise, mottling and hair; the same seed gives the same bytes")
      ->capture_default_str();
  command.add_option("--iso", c.render.sensor.iso, "Sensor speed, sets the noise")->check(CLI::Range(100, 6400));
  command.add_flag("--no-noise", options.no_noise, "Leave out shot and read noise");
  command.add_option("--flash", c.render.light.flash, "Exposure by the flash: white reaches this share of saturation")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--ambient", c.render.light.ambient, "Exposure by room light alone")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--velocity", options.velocity_mm_s, "Of the body: x y z, mm/s")->expected(3);
  command.add_option("--exposure-ms", options.exposure_ms, "Time for which the flash lights the moving body")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command.add_option("--motion-px", options.motion_px, "Motion in the image instead of a velocity: x y, px")
      ->expected(2)
      ->excludes("--velocity");
  command.add_option("--label", options.labels, "ArUco label (DICT_4X4_1000) on the body: ID,SIDE,X,Y in mm")
      ->take_all();
  command.add_option("--threads", c.render.threads, "Changes the time only")->check(CLI::Range(1, 64));
}

void AddFile(CLI::App& command, SceneOptions& options) {
  SimulationOptions& c = options.common;
  c.taken = "2026:01:05 10:00:00";
  c.serial = "3990001";
  command.add_option("--quality", c.quality, "JPEG quality")->check(CLI::Range(1, 100))->capture_default_str();
  command.add_option("--orientation", c.orientation, "EXIF Orientation to write")->check(CLI::Range(1, 8));
  command.add_option("--taken", c.taken, "EXIF time, \"YYYY:MM:DD hh:mm:ss\"")->capture_default_str();
  command.add_option("--serial", c.serial, "Camera serial number in the MakerNote")->capture_default_str();
}

}  // namespace

CLI::App* AddScene(CLI::App& root, Context& context, const std::string& name, const std::string& description,
                   const std::string& example, const char* range, Scene scene) {
  CLI::App& group = Group(root, "simulate", "Photograph bodies of known shape with the virtual rig");
  CLI::App* command = AddCommand(group, context, name, description, example);
  const auto options = std::make_shared<SceneOptions>();
  AddRig(*command, *options, range);
  AddLightAndSensor(*command, *options);
  AddFile(*command, *options);
  OnRun(command, context,
        [options, name, scene = std::move(scene)](Context& run) { return Simulate(run, *options, name, scene); });
  return command;
}

}  // namespace striae::app
