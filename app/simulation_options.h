// The options that every scene of `striae simulate` shares.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/simulation.h"

namespace striae::app {

struct SceneOptions {
  SimulationOptions common;
  std::vector<std::string> labels;                ///< "ID,SIDE,X,Y" each
  std::vector<double> velocity_mm_s = {0, 0, 0};  ///< of the body
  double exposure_ms = 1;                  ///< the pop-up flash's; the shutter's 5 ms matter to ambient light only
  std::vector<double> motion_px = {0, 0};  ///< instead of a velocity
  bool no_noise = false;
};

using Scene = std::function<Status(Simulation&)>;

/// The command `striae simulate NAME` with the shared options; `range` is the default range.
CLI::App* AddScene(CLI::App& root, Context& context, const std::string& name, const std::string& description,
                   const std::string& example, const char* range, Scene scene);

}  // namespace striae::app
