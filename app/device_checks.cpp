#include "app/device_checks.h"

#include <algorithm>

namespace striae::app {

using store::Record;

Result<TimeSpan> ParseCheckTime(const std::string& text, const UtcTime& now) {
  if (text.empty()) return TimeSpan{now, now};
  if (const auto instant = UtcTime::Parse(text)) return TimeSpan{*instant, *instant};
  const auto day = Date::Parse(text);
  if (!day) return Fail(day.error());
  constexpr std::int64_t kMsPerDay = 86'400'000;
  const UtcTime begin{day->DaysSinceEpoch() * kMsPerDay};
  // A check of today is over by now.
  const UtcTime end{begin.unix_ms + kMsPerDay - 1};
  return TimeSpan{begin, end > now && begin <= now ? now : end};
}

Result<std::optional<CalibrationFile>> CalibrationForCheck(Record& record, const Device& device, const Date& day,
                                                           const std::optional<CalibrationFile>& given) {
  const auto known = record.Calibrations(device.id);
  if (!known) return Fail(known.error());
  if (given) {
    const bool ours = std::any_of(known->begin(), known->end(), [&](const CalibrationReference& calibration) {
      return calibration.sha256 == given->sha256;
    });
    if (ours) return given;
    return Fail(ErrorCode::kRecordRefused, "this calibration is none of device " + device.serial +
                                               "'s; add it first with 'striae calibration add', or leave "
                                               "--calibration out");
  }
  if (known->empty()) return std::optional<CalibrationFile>();
  const auto in_force = record.CalibrationOn(device.id, day);
  if (!in_force) return Fail(in_force.error());
  const auto bytes = record.objects().Get(in_force->sha256);
  if (!bytes) return Fail(bytes.error());
  auto parsed = ParseCalibrationFile(*bytes, "the calibration of device " + device.serial);
  if (!parsed) return Fail(parsed.error());
  return std::optional(*std::move(parsed));
}

Status BelongsTo(Record& record, const Device& device, const CheckInput& input) {
  if (!input.body_serial.empty() && input.body_serial != device.serial) {
    return Fail(ErrorCode::kRecordRefused, input.file + " was taken with body " + input.body_serial +
                                               ", not with device " + device.serial + "; give the device that took it");
  }
  const auto known = record.Calibrations(device.id);
  if (!known) return Fail(known.error());
  const bool ours =
      input.calibration && std::any_of(known->begin(), known->end(), [&](const CalibrationReference& calibration) {
        return calibration.sha256 == *input.calibration;
      });
  if (ours) return {};
  return Fail(ErrorCode::kRecordRefused,
              input.file +
                  (input.calibration ? " was measured with a calibration that is none of device "
                                     : " does not say which calibration it was measured with, so it proves "
                                       "nothing about device ") +
                  device.serial +
                  "; check from the photograph, or from the PLY that 'striae reconstruct' made with it");
}

Result<std::optional<store::Doubt>> DoubtAbout(Record& record, const store::WorkItem& item) {
  if (!item.device) return std::optional<store::Doubt>();
  const auto checks = store::DeviceChecks(record, item.device->id);
  if (!checks) return Fail(checks.error());
  return store::DoubtAt(*checks, item.session.opened_at);
}

void Flag(AnalysisReport& report, const store::Doubt& doubt) { FlagAll(report, doubt.reason); }

}  // namespace striae::app
