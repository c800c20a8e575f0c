// Checks of the study's devices against artefacts (plane, ball, ball bar), and what a failed one means for captures.
// Append-only and audited as everything in the record.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/hex.h"
#include "core/id.h"
#include "core/result.h"
#include "core/time.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

using DeviceCheckId = Id<struct DeviceCheckTag>;

struct DeviceCheck {  // NOLINT(bugprone-exception-escape): nlohmann's own noexcept move
  DeviceCheckId id;
  DeviceId device;
  std::string kind;     ///< "plane", "ball", "distance"
  UtcTime from, until;  ///< when: one instant, or a whole day when only the day is known
  bool passed = false;
  Sha256 evidence;        ///< of the photograph or surface that it rests on (the first, when there are several)
  nlohmann::json result;  ///< figures, tolerances, and the SHA-256 of every input and calibration
  std::string by;         ///< filled in by AddDeviceCheck
  UtcTime at;             ///< when it was recorded; filled in by AddDeviceCheck
};

/// kNotFound for a device that is not in the study; kUsage for an unknown kind, an empty span, or a time that is later
/// than the stamp's. The same check of the same evidence with the same result again adds nothing.
Result<DeviceCheck> AddDeviceCheck(Record& record, const DeviceCheck& check, const Stamp& stamp);

/// By time, those of one time in the order in which they were recorded.
Result<std::vector<DeviceCheck>> DeviceChecks(Record& record, const DeviceId& device);

/// Why what a device measured at some time is not trusted.
struct Doubt {
  DeviceCheckId check;
  Sha256 evidence;
  std::string reason;
};

/// A failed check puts in doubt everything between the last passed check of the same kind before it (all there is when
/// there was none) and the next passed one after it: when the device went out of tolerance is not known. What lies
/// after the failed check, or on its day, is said to be so; the rest may have been affected. `checks` as DeviceChecks
/// gives them.
std::optional<Doubt> DoubtAt(const std::vector<DeviceCheck>& checks, const UtcTime& time);

nlohmann::json ToJson(const DeviceCheck& check);

}  // namespace striae::store
