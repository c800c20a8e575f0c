#include "store/detail/codec.h"

#include <algorithm>

#include "store/detail/failed.h"
#include "store/objects.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

template <typename T>
void Put(json& object, const char* name, const std::optional<T>& value) {
  if (value) object[name] = *value;
}

template <typename T>
void Get(const json& object, const char* name, std::optional<T>& value) {
  if (const auto found = object.find(name); found != object.end() && !found->is_null()) value = found->get<T>();
}

}  // namespace

json MetadataToJson(const PhotoMetadata& m) {
  json object = {{"make", m.make},
                 {"model", m.model},
                 {"body_serial", m.body_serial},
                 {"lens", m.lens},
                 {"taken_at_camera_clock", m.taken_at_camera_clock},
                 {"quality", m.quality},
                 {"focus_mode", m.focus_mode},
                 {"white_balance", m.white_balance},
                 {"user_comment", m.user_comment},
                 {"width_px", m.width_px},
                 {"height_px", m.height_px}};
  Put(object, "exposure_s", m.exposure_s);
  Put(object, "f_number", m.f_number);
  Put(object, "focal_length_mm", m.focal_length_mm);
  Put(object, "focus_distance_m", m.focus_distance_m);
  Put(object, "iso", m.iso);
  Put(object, "orientation", m.orientation);
  Put(object, "shutter_count", m.shutter_count);
  Put(object, "flash_fired", m.flash_fired);
  return object;
}

PhotoMetadata MetadataFromJson(const json& object) {
  PhotoMetadata m;
  m.make = object.value("make", "");
  m.model = object.value("model", "");
  m.body_serial = object.value("body_serial", "");
  m.lens = object.value("lens", "");
  m.taken_at_camera_clock = object.value("taken_at_camera_clock", "");
  m.quality = object.value("quality", "");
  m.focus_mode = object.value("focus_mode", "");
  m.white_balance = object.value("white_balance", "");
  m.user_comment = object.value("user_comment", "");
  m.width_px = object.value("width_px", 0);
  m.height_px = object.value("height_px", 0);
  Get(object, "exposure_s", m.exposure_s);
  Get(object, "f_number", m.f_number);
  Get(object, "focal_length_mm", m.focal_length_mm);
  Get(object, "focus_distance_m", m.focus_distance_m);
  Get(object, "iso", m.iso);
  Get(object, "orientation", m.orientation);
  Get(object, "shutter_count", m.shutter_count);
  Get(object, "flash_fired", m.flash_fired);
  return m;
}

json PreflightToJson(const std::vector<PreflightItem>& items) {
  json list = json::array();
  for (const PreflightItem& item : items) {
    list.push_back({{"name", item.name},
                    {"state", ToString(item.state)},
                    {"found", item.found},
                    {"expected", item.expected},
                    {"advice", item.advice}});
  }
  return list;
}

std::vector<PreflightItem> PreflightFromJson(const json& list) {
  using State = PreflightItem::State;
  std::vector<PreflightItem> items;
  for (const json& object : list) {
    PreflightItem item{object.value("name", ""), State::kUnknown, object.value("found", ""),
                       object.value("expected", ""), object.value("advice", "")};
    for (const State state : {State::kOk, State::kWarning, State::kFailed}) {
      if (object.value("state", "") == ToString(state)) item.state = state;
    }
    items.push_back(std::move(item));
  }
  return items;
}

json ProvenanceToJson(const Provenance& provenance) {
  json object = {{"software", provenance.software},
                 {"version", provenance.version},
                 {"inputs", json::array()},
                 {"parameters", provenance.parameters}};
  for (const ProvenanceInput& input : provenance.inputs) {
    object["inputs"].push_back({{"name", input.name}, {"sha256", input.sha256.ToString()}});
  }
  return object;
}

Provenance ProvenanceFromJson(const json& object) {
  Provenance provenance;
  provenance.software = object.value("software", "");
  provenance.version = object.value("version", "");
  provenance.parameters = object.value("parameters", json::object());
  for (const json& input : object.value("inputs", json::array())) {
    provenance.inputs.push_back({input.value("name", ""), Unwrap(Sha256::Parse(input.value("sha256", "")))});
  }
  return provenance;
}

std::string Dump(const json& object) { return object.dump(-1, ' ', false, json::error_handler_t::replace); }

Uuid UuidFrom(std::initializer_list<std::string> parts) {
  std::vector<std::uint8_t> bytes;
  for (const std::string& part : parts) {
    const std::string length = std::to_string(part.size()) + ":";
    bytes.insert(bytes.end(), length.begin(), length.end());
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  const Sha256 digest = HashOf(bytes);
  Uuid uuid;
  std::copy_n(digest.bytes.begin(), uuid.bytes.size(), uuid.bytes.begin());
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0f) | 0x80);
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3f) | 0x80);
  return uuid;
}

ErrorCode ErrorCodeFrom(std::string_view text) {
  for (int value = 0; value <= static_cast<int>(ErrorCode::kInternal); ++value) {
    if (ToString(static_cast<ErrorCode>(value)) == text) return static_cast<ErrorCode>(value);
  }
  return ErrorCode::kInternal;
}

}  // namespace striae::store::detail
