#include "tests/support/ptp_camera.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <utility>

namespace striae::testing {
namespace {

constexpr std::uint32_t kStore = 0x00010001, kDcim = 0x01000001, kFolder = 0x01000002, kFirstFile = 0x01000010;
constexpr std::uint16_t kOk = 0x2001, kNotSupported = 0x2005, kInvalidHandle = 0x2009, kNoSuchProperty = 0x200A,
                        kFull = 0x200C, kBusy = 0x2019, kOutOfFocus = 0xA002;
constexpr std::uint16_t kObjectAdded = 0x4002, kCaptureComplete = 0x400D;

PtpReply Code(std::uint16_t code) {
  PtpReply reply;
  reply.code = code;
  return reply;
}
PtpReply Data(PtpWriter& writer) {
  PtpReply reply;
  reply.has_data = true;
  reply.data = std::move(writer.bytes);
  return reply;
}

std::vector<PtpEvent> TakeDue(auto& announcements, std::int64_t now_ms) {
  std::vector<PtpEvent> due;
  std::erase_if(announcements, [&](const auto& announcement) {
    if (announcement.at_ms > now_ms) return false;
    due.push_back(announcement.event);
    return true;
  });
  return due;
}

}  // namespace

bool ParsePtpFault(const std::string& name, PtpFault& fault) {
  static const std::array<std::pair<const char*, PtpFault>, 11> kNames{{{"none", PtpFault::kNone},
                                                                        {"out-of-focus", PtpFault::kOutOfFocus},
                                                                        {"store-full", PtpFault::kStoreFull},
                                                                        {"busy", PtpFault::kBusy},
                                                                        {"busy-twice", PtpFault::kBusyTwice},
                                                                        {"no-event", PtpFault::kNoEvent},
                                                                        {"truncated", PtpFault::kTruncated},
                                                                        {"corrupt", PtpFault::kCorrupt},
                                                                        {"stall", PtpFault::kStall},
                                                                        {"silent", PtpFault::kSilent},
                                                                        {"shutter-by-hand", PtpFault::kShutterByHand}}};
  for (const auto& [text, value] : kNames) {
    if (name == text) {
      fault = value;
      return true;
    }
  }
  return false;
}

PtpCamera::PtpCamera(PtpCameraOptions options) : options_(std::move(options)) {}

PtpReply PtpCamera::Handle(std::uint16_t operation, const std::vector<std::uint32_t>& parameters,
                           const PtpBytes& /*data_in*/, std::int64_t now_ms) {
  const auto parameter = [&](std::size_t i) { return i < parameters.size() ? parameters[i] : 0; };
  switch (operation) {
    case 0x1001:
      return DeviceInfo();
    case 0x1002:  // OpenSession
      if (options_.fault == PtpFault::kShutterByHand && exposures_ == 0) Expose(now_ms);
      return Code(kOk);
    case 0x1003:  // CloseSession
    case 0x1016:  // SetDevicePropValue: all settings are taken
    case 0x90C2:  // ChangeCameraMode
    case 0x90C8:  // DeviceReady
    case 0x9202:  // EndLiveView
      return Code(kOk);
    case 0x1004: {
      PtpWriter writer;
      writer.Array32({kStore});
      return Data(writer);
    }
    case 0x1005:
      return StorageInfo();
    case 0x1007:
      return Handles(parameter(2));
    case 0x1008:
      return ObjectInfo(parameter(0));
    case 0x1009:
      return Part(parameter(0), 0, std::numeric_limits<std::uint32_t>::max());
    case 0x101B:
      return Part(parameter(0), parameter(1), parameter(2));
    case 0x100E:
      return Trigger(now_ms);
    case 0x1014:
      return PropertyDescription(static_cast<std::uint16_t>(parameter(0)));
    case 0x90C7:
      return PolledEvents(now_ms);
    case 0x90CA: {  // GetVendorPropCodes
      PtpWriter writer;
      writer.Array16({0xD1C0, 0xD1C1});
      return Data(writer);
    }
    default:
      return Code(kNotSupported);
  }
}

PtpReply PtpCamera::DeviceInfo() const {
  PtpWriter writer;
  writer.U16(100).U32(0x0A).U16(100).Text("microsoft.com: 1.0").U16(0);
  writer.Array16({0x1001, 0x1002, 0x1003, 0x1004, 0x1005, 0x1006, 0x1007, 0x1008, 0x1009, 0x100A, 0x100B,
                  0x100C, 0x100D, 0x100E, 0x100F, 0x1014, 0x1015, 0x1016, 0x101B, 0x90C0, 0x90C1, 0x90C2,
                  0x90C3, 0x90C4, 0x90C7, 0x90C8, 0x90C9, 0x90CA, 0x90CB, 0x90CC, 0x90CD, 0x90CE, 0x90CF,
                  0x9200, 0x9201, 0x9202, 0x9203, 0x9204, 0x9205, 0x9206, 0x9801, 0x9802, 0x9803, 0x9805});
  writer.Array16(
      {0x4001, 0x4002, 0x4004, 0x4005, 0x4006, 0x4009, 0x400A, 0x400C, 0x400D, 0x4008, 0xC101, 0xC102, 0xC104});
  writer.Array16({0x5001, 0x5003, 0x5004, 0x5005, 0x5007, 0x5008, 0x500A, 0x500B, 0x500C, 0x500D, 0x500E, 0x500F,
                  0x5010, 0x5011, 0x5013, 0x5018, 0x501C, 0xD406, 0xD407});
  writer.Array16({0x3801, 0x3000}).Array16({0x3801, 0x3000, 0x3001, 0x300A, 0x3006, 0x3002});
  writer.Text("Nikon Corporation").Text("D90").Text("V1.00").Text(options_.serial);
  return Data(writer);
}

PtpReply PtpCamera::StorageInfo() const {
  const bool full = options_.fault == PtpFault::kStoreFull;
  PtpWriter writer;
  writer.U16(4).U16(3).U16(2);  // removable RAM, DCF, read-only with delete: as the body reports its card
  writer.U64(8160542720ULL).U64(full ? 0 : 7973502976ULL).U32(full ? 0 : 2134).Text("").Text("");
  return Data(writer);
}

PtpReply PtpCamera::Handles(std::uint32_t parent) const {
  std::vector<std::uint32_t> handles;
  const bool all = parent == 0;
  if (all || parent == 0xFFFFFFFF) handles.push_back(kDcim);
  if (all || parent == kDcim) handles.push_back(kFolder);
  if (all || parent == kFolder) {
    for (const auto& [handle, object] : objects_) handles.push_back(handle);
  }
  PtpWriter writer;
  writer.Array32(handles);
  return Data(writer);
}

PtpReply PtpCamera::ObjectInfo(std::uint32_t handle) const {
  const auto file = objects_.find(handle);
  const bool folder = handle == kDcim || handle == kFolder;
  if (!folder && file == objects_.end()) return Code(kInvalidHandle);
  const auto size = folder ? 0U : static_cast<std::uint32_t>(file->second.bytes.size());
  PtpWriter writer;
  writer.U32(kStore).U16(folder ? 0x3001 : 0x3801).U16(0).U32(size).U16(0x3808).U32(0).U32(0).U32(0);
  writer.U32(folder ? 0 : 4288).U32(folder ? 0 : 2848).U32(folder ? 0 : 24);
  writer.U32(handle == kDcim ? 0 : handle == kFolder ? kDcim : kFolder).U16(folder ? 1 : 0).U32(0).U32(0);
  writer.Text(handle == kDcim ? "DCIM" : handle == kFolder ? "100NCD90" : file->second.name);
  writer.Text("20260504T070809").Text("20260504T070809").Text("");
  return Data(writer);
}

PtpReply PtpCamera::Part(std::uint32_t handle, std::uint64_t offset, std::uint64_t count) const {
  const auto file = objects_.find(handle);
  if (file == objects_.end()) return Code(kInvalidHandle);
  PtpBytes bytes = file->second.bytes;
  if (options_.fault == PtpFault::kTruncated) bytes.resize(bytes.size() / 2);
  if (options_.fault == PtpFault::kCorrupt) {
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), bytes.end(), std::uint8_t{0});
  }
  const std::uint64_t from = std::min<std::uint64_t>(offset, bytes.size());
  const std::uint64_t size = std::min<std::uint64_t>(count, bytes.size() - from);
  PtpReply reply;
  reply.has_data = true;
  reply.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                    bytes.begin() + static_cast<std::ptrdiff_t>(from + size));
  reply.parameters = {static_cast<std::uint32_t>(size)};
  reply.stalls = options_.fault == PtpFault::kStall;
  return reply;
}

PtpReply PtpCamera::Trigger(std::int64_t now_ms) {
  switch (options_.fault) {
    case PtpFault::kOutOfFocus:
      return Code(kOutOfFocus);
    case PtpFault::kStoreFull:
      return Code(kFull);
    case PtpFault::kBusy:
      return Code(kBusy);
    case PtpFault::kBusyTwice:
      if (busy_replies_++ < 2) return Code(kBusy);
      break;
    case PtpFault::kSilent: {
      PtpReply silence;
      silence.stalls = true;
      return silence;
    }
    default:
      break;
  }
  Expose(options_.fault == PtpFault::kNoEvent ? std::numeric_limits<std::int64_t>::max() : now_ms + options_.delay_ms);
  return Code(kOk);
}

void PtpCamera::Expose(std::int64_t announced_at_ms) {
  if (options_.photographs.empty()) return;
  const auto handle = kFirstFile + static_cast<std::uint32_t>(exposures_);
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "DSC_%04u.JPG", static_cast<unsigned>(exposures_ % 9999 + 1));
  objects_[handle] = {name.data(), options_.photographs[exposures_ % options_.photographs.size()]};
  ++exposures_;
  // Both ways of hearing about it, as on the body: the first ObjectAdded arrives twice.
  for (const auto& event : {PtpEvent{kObjectAdded, handle}, PtpEvent{kCaptureComplete, 0}}) {
    for_pipe_.push_back({announced_at_ms, event});
    for_polling_.push_back({announced_at_ms, event});
  }
}

std::vector<PtpEvent> PtpCamera::DueEvents(std::int64_t now_ms) { return TakeDue(for_pipe_, now_ms); }

PtpReply PtpCamera::PolledEvents(std::int64_t now_ms) {
  const auto due = TakeDue(for_polling_, now_ms);
  PtpWriter writer;
  writer.U16(static_cast<std::uint32_t>(due.size()));
  for (const auto& event : due) writer.U16(event.code).U32(event.parameter);
  return Data(writer);
}

PtpReply PtpCamera::PropertyDescription(std::uint16_t property) {
  constexpr int kU8 = 2, kU16 = 4, kU32 = 6, kReadOnly = 0, kWritable = 1;
  PtpWriter writer;
  const auto u8 = [&](std::uint32_t value, std::uint32_t high) {  // read-only, range 0..high
    writer.U16(property).U16(kU8).U8(kReadOnly).U8(value).U8(value).U8(1).U8(0).U8(high).U8(1);
    return Data(writer);
  };
  switch (property) {
    case 0x5001:
      return u8(90, 100);  // battery
    case 0xD1C0:           // flash open
    case 0xD1C1:           // flash charged
      return u8(1, 1);
    case 0x5007:  // f/11
      writer.U16(property).U16(kU16).U8(kWritable).U16(1100).U16(1100).U8(2).U16(3).U16(800).U16(1100).U16(1600);
      return Data(writer);
    case 0x500A:  // focus mode: manual
      writer.U16(property).U16(kU16).U8(kReadOnly).U16(1).U16(1).U8(2).U16(2).U16(1).U16(0x8012);
      return Data(writer);
    case 0x500D:  // 1/200 s in units of 0.1 ms
      writer.U16(property).U16(kU32).U8(kWritable).U32(50).U32(50).U8(2).U16(2).U32(50).U32(40);
      return Data(writer);
    case 0x500E:  // dial: M
      writer.U16(property).U16(kU16).U8(kReadOnly).U16(1).U16(1).U8(2).U16(2).U16(1).U16(2);
      return Data(writer);
    case 0x500F:  // ISO
      writer.U16(property).U16(kU16).U8(kWritable).U16(400).U16(400).U8(2).U16(3).U16(200).U16(400).U16(500);
      return Data(writer);
    default:
      return Code(kNoSuchProperty);
  }
}

}  // namespace striae::testing
