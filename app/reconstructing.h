// What both ways of running `striae reconstruct` share: the whole command, and the short way of app/front.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/command.h"
#include "core/calibration.h"
#include "core/hex.h"
#include "core/result.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {

/// A monotone clock in seconds.
double Now();

Result<Calibration> ReadCalibration(const std::filesystem::path& path, Sha256& sha256);

/// Provenance at the head of a surface's comments.
void SayWhatItIsMadeOf(const Sha256& photograph, const Sha256& calibration, std::vector<std::string>& comments);

struct SurfaceSize {
  std::size_t points = 0, faces = 0;
};

/// Warnings to the terminal, and the result: CONTRACT's JSON with `more` merged into it.
void Announce(Context& context, const reconstruct::ReconstructionReport& result, const SurfaceSize& size,
              const nlohmann::json& more, const std::filesystem::path& out);

}  // namespace striae::app
