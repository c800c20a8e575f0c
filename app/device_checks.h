// What a study's checks of its devices need besides the record: their time, their calibration, and their effect.
#pragma once

#include <optional>
#include <string>

#include "app/verification.h"
#include "core/measurement.h"
#include "core/time.h"
#include "store/device_checks.h"
#include "store/record.h"

namespace striae::app {

struct TimeSpan {
  UtcTime from, until;
};
/// A day (all of it, UTC), an instant, or `now` when empty. kUsage otherwise.
Result<TimeSpan> ParseCheckTime(const std::string& text, const UtcTime& now);

/// The calibration that a check of the device measures photographs with: the one in force on that day. One that was
/// `given` must be one of the device's (kRecordRefused). Nothing where neither is there.
Result<std::optional<CalibrationFile>> CalibrationForCheck(store::Record& record, const Device& device, const Date& day,
                                                           const std::optional<CalibrationFile>& given);

/// kRecordRefused for a photograph of another camera body, and for a surface that was not made with a calibration of
/// this device (or does not say with which).
Status BelongsTo(store::Record& record, const Device& device, const CheckInput& input);

/// Why a capture's device is not trusted at its session's time.
Result<std::optional<store::Doubt>> DoubtAbout(store::Record& record, const store::WorkItem& item);
/// Every measurement is flagged with the doubt's reason, after any reason of its own.
void Flag(AnalysisReport& report, const store::Doubt& doubt);

}  // namespace striae::app
