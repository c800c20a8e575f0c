// What there is to process, each capture with the device, calibration and outline in force for it.
#include "store/detail/impl.h"
#include "store/detail/read.h"

namespace striae::store {
namespace {

using detail::Database;
using detail::Guarded;

std::string Name(const Device& device) { return device.serial + " (" + std::string(ToString(device.range)) + ")"; }

/// The device that took a photograph: by body serial where the file has one, else any; of several, by the rig's range
/// (wounds are photographed at the small one, heads at the large one). Sets `missing` when none is left or more.
std::optional<Device> DeviceOf(const std::vector<Device>& all, const Capture& capture, std::string& missing) {
  const std::string& serial = capture.metadata.body_serial;
  std::vector<Device> fitting = all;
  if (!serial.empty()) std::erase_if(fitting, [&](const Device& device) { return device.serial != serial; });
  if (fitting.empty()) {
    missing = serial.empty() ? "the study has no device; add it with 'striae device add'"
                             : "the photograph was taken with body " + serial +
                                   ", which is no device of this study; add it with 'striae device add --serial " +
                                   serial + " --range ...'";
    return std::nullopt;
  }
  if (fitting.size() == 1) return fitting.front();
  const RigRange range = capture.role.kind == CaptureRole::Kind::kWound ? RigRange::kSmall : RigRange::kLarge;
  std::erase_if(fitting, [&](const Device& device) { return device.range != range; });
  if (fitting.size() == 1) return fitting.front();
  missing = "several devices can have taken this photograph, which names no body serial: ";
  for (const Device& device : all) missing += Name(device) + " ";
  missing += "; import the file as the camera wrote it, with its EXIF data";
  return std::nullopt;
}

}  // namespace

Result<std::vector<WorkItem>> Record::Work(std::optional<SessionId> session) {
  return Guarded([&] {
    Database& database = impl_->database;
    const std::string sql = std::string(detail::kCaptures) + " WHERE role <> 'unassigned'";
    if (session) detail::GetSession(database, *session);
    const auto captures =
        session ? database.Rows(sql + " AND session_id = ? ORDER BY number", detail::ReadCapture, *session)
                : database.Rows(sql + " ORDER BY session_id, number", detail::ReadCapture);
    const auto devices = database.Rows(detail::kDevices, detail::ReadDevice);
    std::vector<WorkItem> items;
    for (const Capture& capture : captures) {
      WorkItem item;
      item.capture = capture;
      item.session = detail::GetSession(database, capture.session);
      item.subject = detail::GetSubject(database, item.session.subject);
      item.device = DeviceOf(devices, capture, item.missing);
      if (item.device) {
        auto calibration = CalibrationOn(item.device->id, Date::Of(item.session.opened_at));
        if (calibration) {
          item.calibration = *calibration;
        } else if (calibration.error().code == ErrorCode::kRecordRefused) {
          item.missing = calibration.error().message;
        } else {
          detail::Unwrap(std::move(calibration));
        }
      }
      item.outline = detail::FindOutline(database, impl_->objects, capture.id);
      item.outcomes =
          database.Rows(std::string(detail::kOutcomeColumns) + "outcome_now WHERE capture_id = ? ORDER BY number",
                        detail::ReadOutcome, capture.id);
      items.push_back(std::move(item));
    }
    return items;
  });
}

}  // namespace striae::store
