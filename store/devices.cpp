// Devices and the calibrations in force for them.
#include "core/calibration.h"
#include "store/detail/keep.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {

Status Record::AddDevice(const Device& device, const Stamp& stamp) {
  return Guarded([&] {
    if (device.serial.empty()) {
      Refuse(ErrorCode::kUsage, "a device needs the camera body's serial number; it stands under the body and in EXIF");
    }
    Database& database = impl_->database;
    Change change(database, stamp);
    if (database.Count("SELECT count(*) FROM device WHERE serial = ? AND range = ?", device.serial,
                       ToString(device.range)) != 0) {
      Refuse(ErrorCode::kRecordRefused,
             "device " + device.serial + " (" + std::string(ToString(device.range)) + ") is in this study already");
    }
    change.Insert("device", {{"id", ToValue(device.id)},
                             {"serial", ToValue(device.serial)},
                             {"range", ToValue(ToString(device.range))},
                             {"model", ToValue(device.model)},
                             {"lens", ToValue(device.lens)}});
    change.Commit();
  });
}

Result<std::vector<Device>> Record::Devices() {
  return Guarded([&] {
    return impl_->database.Rows(std::string(detail::kDevices) + " ORDER BY serial, range DESC", detail::ReadDevice);
  });
}

Result<Device> Record::DeviceBySerial(std::string_view serial, std::optional<RigRange> range) {
  return Guarded([&] {
    auto devices =
        impl_->database.Rows(std::string(detail::kDevices) + " WHERE serial = ?", detail::ReadDevice, serial);
    if (range) std::erase_if(devices, [&](const Device& device) { return device.range != *range; });
    const std::string name = "'" + std::string(serial.substr(0, 40)) + "'";
    if (devices.empty()) {
      Refuse(ErrorCode::kNotFound, "no device " + name + (range ? " (" + std::string(ToString(*range)) + ")" : "") +
                                       " in this study; add it with 'striae device add --serial ... --range ...'");
    }
    if (devices.size() > 1) {
      Refuse(ErrorCode::kUsage, "device " + name + " has a small and a large range; say which with --range");
    }
    return devices.front();
  });
}

Result<CalibrationReference> Record::AddCalibration(const CalibrationId& id, const DeviceId& device,
                                                    std::span<const std::uint8_t> json_bytes, const Date& valid_from,
                                                    const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(CalibrationFromJson({reinterpret_cast<const char*>(json_bytes.data()), json_bytes.size()}));
    Database& database = impl_->database;
    detail::GetDevice(database, device);
    const Sha256 sha256 = detail::Unwrap(impl_->objects.Put(json_bytes));
    Change change(database, stamp);
    const auto same =
        database.One(std::string(detail::kCalibrations) + " WHERE device_id = ? AND sha256 = ? AND valid_from = ?",
                     detail::ReadCalibration, device, sha256, valid_from);
    if (same) return *same;
    detail::InsertObject(change, database, sha256, json_bytes.size(), stamp);
    change.Insert("calibration",
                  {{"id", ToValue(id)},
                   {"device_id", ToValue(device)},
                   {"number", detail::NextNumber(database, "calibration", "device_id", device.ToString())},
                   {"sha256", ToValue(sha256)},
                   {"valid_from", ToValue(valid_from)}});
    change.Commit();
    return CalibrationReference{id, device, sha256, valid_from};
  });
}

Result<std::vector<CalibrationReference>> Record::Calibrations(const DeviceId& device) {
  return Guarded([&] {
    detail::GetDevice(impl_->database, device);
    return impl_->database.Rows(std::string(detail::kCalibrations) + " WHERE device_id = ? ORDER BY valid_from, number",
                                detail::ReadCalibration, device);
  });
}

Result<CalibrationReference> Record::CalibrationOn(const DeviceId& device, const Date& day) {
  return Guarded([&] {
    const Device of = detail::GetDevice(impl_->database, device);
    // ISO dates sort as text; among those of one day the one added last counts.
    auto found = impl_->database.One(std::string(detail::kCalibrations) +
                                         " WHERE device_id = ? AND valid_from <= ? "
                                         "ORDER BY valid_from DESC, number DESC LIMIT 1",
                                     detail::ReadCalibration, device, day);
    if (!found) {
      Refuse(ErrorCode::kRecordRefused, "device " + of.serial + " (" + std::string(ToString(of.range)) +
                                            ") has no calibration valid on " + day.ToString() +
                                            "; add one with 'striae calibration add cal.json --device " + of.serial +
                                            " --valid-from DATE'");
    }
    return *found;
  });
}

}  // namespace striae::store
