#include "store/device_checks.h"

#include <algorithm>

#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kChecks =
    "SELECT id, device_id, kind, checked_from, checked_until, passed, evidence, result, by, at FROM device_check "
    "WHERE device_id = ? ORDER BY checked_until, number";

DeviceCheck ReadCheck(const RowView& row) {
  DeviceCheck check;
  check.id = row.Key<DeviceCheckId>(0);
  check.device = row.Key<DeviceId>(1);
  check.kind = row.Text(2);
  check.from = row.Time(3);
  check.until = row.Time(4);
  check.passed = row.Integer(5) != 0;
  check.evidence = row.Hash(6);
  check.result = nlohmann::json::parse(row.Text(7));
  check.by = row.Text(8);
  check.at = row.Time(9);
  return check;
}

void Validate(const DeviceCheck& check, const Stamp& stamp) {
  if (check.kind != "plane" && check.kind != "ball" && check.kind != "distance") {
    Refuse(ErrorCode::kUsage, "a check is of a plane, a ball or a distance, not of '" + check.kind.substr(0, 40) + "'");
  }
  if (check.until < check.from) Refuse(ErrorCode::kUsage, "a check cannot end before it begins");
  if (stamp.now < check.from) {
    Refuse(ErrorCode::kUsage, "a check on " + Date::Of(check.from).ToString() + " lies in the future; see --date");
  }
}

std::string DayOf(const UtcTime& time) { return Date::Of(time).ToString(); }

/// What one failed check says about a time, or nothing: from `before` to `after` it is in doubt.
std::optional<Doubt> DoubtFrom(const DeviceCheck& failed, const DeviceCheck* before, const DeviceCheck* after,
                               const UtcTime& time) {
  const bool on_that_day = time >= failed.from && time <= failed.until;
  const bool between = (before == nullptr || time > before->until) && (after == nullptr || time < after->from);
  if (!on_that_day && !between) return std::nullopt;
  const std::string name = "the check of its device (" + failed.kind + ", " + failed.id.ToString().substr(0, 8) +
                           ") on " + DayOf(failed.from);
  const std::string since = before == nullptr ? "no check had been passed before"
                                              : "the last passed check before was on " + DayOf(before->from);
  std::string reason = time >= failed.from ? "taken after " + name + " had failed, before one was passed again"
                                           : "taken before " + name + " failed; " + since;
  return Doubt{failed.id, failed.evidence, std::move(reason)};
}

}  // namespace

Result<DeviceCheck> AddDeviceCheck(Record& record, const DeviceCheck& check, const Stamp& stamp) {
  return Guarded([&] {
    Validate(check, stamp);
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    detail::GetDevice(database, check.device);
    for (const DeviceCheck& known : database.Rows(kChecks, ReadCheck, check.device)) {
      if (known.kind == check.kind && known.evidence == check.evidence && known.result == check.result &&
          known.from == check.from && known.until == check.until) {
        return known;
      }
    }
    DeviceCheck kept = check;
    kept.by = detail::CleanText(stamp.user);
    kept.at = stamp.now;
    change.Insert("device_check",
                  {{"id", ToValue(kept.id)},
                   {"device_id", ToValue(kept.device)},
                   {"number", detail::NextNumber(database, "device_check", "device_id", kept.device.ToString())},
                   {"kind", ToValue(kept.kind)},
                   {"checked_from", ToValue(kept.from)},
                   {"checked_until", ToValue(kept.until)},
                   {"passed", ToValue(kept.passed ? 1 : 0)},
                   {"evidence", ToValue(kept.evidence)},
                   {"result", ToValue(detail::Dump(kept.result))},
                   {"by", ToValue(kept.by)},
                   {"at", ToValue(kept.at)}});
    change.Commit();
    return kept;
  });
}

Result<std::vector<DeviceCheck>> DeviceChecks(Record& record, const DeviceId& device) {
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    detail::GetDevice(database, device);
    return database.Rows(kChecks, ReadCheck, device);
  });
}

std::optional<Doubt> DoubtAt(const std::vector<DeviceCheck>& checks, const UtcTime& time) {
  // The newest failure that reaches the time is named: it is what the user can do something about.
  for (auto failed = checks.rbegin(); failed != checks.rend(); ++failed) {
    if (failed->passed) continue;
    const auto passes = [&](const DeviceCheck& other) { return other.passed && other.kind == failed->kind; };
    const auto before = std::find_if(std::next(failed), checks.rend(), passes);
    const auto after = std::find_if(failed.base(), checks.end(), passes);
    auto doubt = DoubtFrom(*failed, before == checks.rend() ? nullptr : &*before,
                           after == checks.end() ? nullptr : &*after, time);
    if (doubt) return doubt;
  }
  return std::nullopt;
}

nlohmann::json ToJson(const DeviceCheck& check) {
  nlohmann::json json = check.result;
  json["id"] = check.id.ToString();
  json["check"] = check.kind;
  json["passed"] = check.passed;
  json["checked_from"] = check.from.ToString();
  json["checked_until"] = check.until.ToString();
  json["recorded_by"] = check.by;
  json["recorded_at"] = check.at.ToString();
  return json;
}

}  // namespace striae::store
