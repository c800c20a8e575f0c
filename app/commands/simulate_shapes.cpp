// `striae simulate plane|ball|blocks|steps`: bodies that a gauge could be, with their truth in the camera frame.
#include "app/command.h"
#include "app/simulation_options.h"
#include "app/simulation_scenes.h"

namespace striae::app {
namespace {

void AddTilt(CLI::App& command, double& tilt_x_deg, double& tilt_y_deg) {
  const auto angle = CLI::Range(-80.0, 80.0);
  command.add_option("--tilt-x", tilt_x_deg, "About the camera's x axis, degrees")->check(angle);
  command.add_option("--tilt-y", tilt_y_deg, "About the camera's y axis, degrees")->check(angle);
}

void AddPlane(CLI::App& root, Context& context) {
  const auto plane = std::make_shared<rig::PlaneOptions>();
  CLI::App* command = AddScene(root, context, "plane", "A flat plate, larger than the stripe field",
                               "striae simulate plane --out scene --tilt-y 10", "small",
                               [plane](Simulation& s) { return SimulatePlane(*plane, s); });
  AddTilt(*command, plane->tilt_x_deg, plane->tilt_y_deg);
}

void AddBall(CLI::App& root, Context& context) {
  const auto ball = std::make_shared<BallScene>();
  CLI::App* command = AddScene(root, context, "ball", "A ball of known centre and radius",
                               "striae simulate ball --out scene --radius-mm 60 --json", "small",
                               [ball](Simulation& s) { return SimulateBall(*ball, s); });
  command->add_option("--radius-mm", ball->radius_mm, "Radius instead of 75 mm for each metre of distance")
      ->check(CLI::Range(1.0, 2000.0));
  command->add_option("--x-mm", ball->x_mm, "Of the centre, to the right")->capture_default_str();
  command->add_option("--y-mm", ball->y_mm, "Of the centre, downwards")->capture_default_str();
}

struct BlocksCommand {
  rig::BlocksOptions blocks;
  double tilt_x_deg = 0, tilt_y_deg = 0;
};

void AddBlocks(CLI::App& root, Context& context) {
  const auto options = std::make_shared<BlocksCommand>();
  CLI::App* command = AddScene(root, context, "blocks", "Blocks of known heights on a plate",
                               "striae simulate blocks --out scene --heights 5 20", "small", [options](Simulation& s) {
                                 return SimulateBlocks(options->blocks, options->tilt_x_deg, options->tilt_y_deg, s);
                               });
  command->add_option("--heights", options->blocks.heights_mm, "Heights, mm, from left to right")->expected(1, 20);
  command->add_option("--block-mm", options->blocks.block_mm, "Side of each block's face")->capture_default_str();
  AddTilt(*command, options->tilt_x_deg, options->tilt_y_deg);
}

struct StepsCommand {
  int steps = 9;
  double step_mm = 25;
};

void AddSteps(CLI::App& root, Context& context) {
  const auto steps = std::make_shared<StepsCommand>();
  CLI::App* command = AddScene(root, context, "steps", "The reference plate on a slide, for calibration",
                               "striae simulate steps --out scene --steps 9 --step-mm 25", "small",
                               [steps](Simulation& s) { return SimulateSteps(steps->steps, steps->step_mm, s); });
  command->add_option("--steps", steps->steps, "Photographs")->check(CLI::Range(2, 50))->capture_default_str();
  command->add_option("--step-mm", steps->step_mm, "Between photographs")->capture_default_str();
}

}  // namespace

void AddCommand_simulate_shapes(CLI::App& root, Context& context) {
  AddPlane(root, context);
  AddBall(root, context);
  AddBlocks(root, context);
  AddSteps(root, context);
}

}  // namespace striae::app
