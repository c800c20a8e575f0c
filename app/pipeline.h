// One photograph's way through Striae, each step one call: decode -> reconstruct -> measure -> record.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.h"
#include "core/study.h"
#include "store/record.h"

namespace striae::app {

/// What became of one capture.
struct Processed {
  enum class State {
    kMeasured,     ///< numbers are in the record
    kSurfaceOnly,  ///< a neutral pose: its surface is what the others are measured against
    kUpToDate,     ///< nothing changed since the outcome in force; nothing was done
    kWaiting,      ///< something is still missing (an outline, a neutral pose); nothing was recorded
    kFailed,       ///< the reason is in the record
  };
  State state = State::kFailed;
  Capture capture;
  std::string analysis;  ///< "wound", "head", "surface"
  std::string text;      ///< the main numbers, or the reason and what to do
  std::string warning;   ///< a label that belongs to another session; empty otherwise
};

/// Called before each capture: how many are done, how many there are, and what comes next.
using Progress = std::function<void(std::size_t done, std::size_t all, const Capture& next)>;

/// Processes every capture with a role, of one session or of the whole study; neutral poses first. A capture that
/// fails does not stop the others. kIo, kRecordDamaged and the like end it: what was recorded before stays.
Result<std::vector<Processed>> ProcessCaptures(store::Record& record, std::optional<SessionId> session,
                                               const Progress& progress);

std::string Describe(const Processed& processed);
nlohmann::json ToJson(const Processed& processed);

}  // namespace striae::app
