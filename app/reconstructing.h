// What both ways of running `striae reconstruct` share: the whole command, and the short way of app/front.cpp.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "app/command.h"
#include "core/calibration.h"
#include "core/hex.h"
#include "core/result.h"
#include "core/surface.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {

/// A monotone clock in seconds.
double Now();

Result<Calibration> ReadCalibration(const std::filesystem::path& path, Sha256& sha256);

/// Provenance at the head of the surface's comments.
void SayWhatItIsMadeOf(const Sha256& photograph, const Sha256& calibration, Surface& surface);

/// Warnings to the terminal, and the result: CONTRACT's JSON with `more` merged into it.
void Announce(Context& context, const reconstruct::Reconstruction& result, const nlohmann::json& more,
              const std::filesystem::path& out);

}  // namespace striae::app
