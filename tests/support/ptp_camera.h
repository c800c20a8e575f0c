// A Nikon D90 as seen through PTP: what it declares, one card, and a photograph that appears after the trigger.
// Declared operations, events and properties are those that libgphoto2 listed from a real body.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/support/ptp_wire.h"

namespace striae::testing {

/// What goes wrong with the shot.
enum class PtpFault {
  kNone,
  kOutOfFocus,     ///< trigger answered A002
  kStoreFull,      ///< trigger answered 200C
  kBusy,           ///< trigger answered 2019 for ever
  kBusyTwice,      ///< trigger answered 2019 two times, then taken
  kNoEvent,        ///< taken, but never announced
  kTruncated,      ///< the transfer delivers half of the file, then zero bytes
  kCorrupt,        ///< the size is right, the second half is zeros
  kStall,          ///< the transfer stops in the middle and nothing is answered any more
  kSilent,         ///< the trigger is never answered
  kShutterByHand,  ///< somebody pressed the camera's own button before the trigger
};
/// Name as on the command line ("out-of-focus"); false when there is no such fault.
bool ParsePtpFault(const std::string& name, PtpFault& fault);

struct PtpCameraOptions {
  std::vector<PtpBytes> photographs;  ///< the n-th trigger takes the n-th, then from the start
  PtpFault fault = PtpFault::kNone;
  int delay_ms = 30;  ///< from trigger to the file's announcement
  std::string serial = "9000001";
};

struct PtpReply {
  std::uint16_t code = 0x2001;
  std::vector<std::uint32_t> parameters;
  bool has_data = false;
  PtpBytes data;
  bool stalls = false;  ///< send half of the data and no answer ever
};

struct PtpEvent {
  std::uint16_t code = 0;
  std::uint32_t parameter = 0;
};

class PtpCamera {
 public:
  explicit PtpCamera(PtpCameraOptions options);

  /// One operation. `now_ms` is any clock that grows.
  PtpReply Handle(std::uint16_t operation, const std::vector<std::uint32_t>& parameters, const PtpBytes& data_in,
                  std::int64_t now_ms);
  /// Events that are due on the event pipe; the same ones are also kept for Nikon's polling (90C7).
  std::vector<PtpEvent> DueEvents(std::int64_t now_ms);

 private:
  struct Object {
    std::string name;
    PtpBytes bytes;
  };
  PtpReply Trigger(std::int64_t now_ms);
  void Expose(std::int64_t announced_at_ms);
  [[nodiscard]] PtpReply DeviceInfo() const;
  [[nodiscard]] PtpReply StorageInfo() const;
  [[nodiscard]] PtpReply Handles(std::uint32_t parent) const;
  [[nodiscard]] PtpReply ObjectInfo(std::uint32_t handle) const;
  [[nodiscard]] PtpReply Part(std::uint32_t handle, std::uint64_t offset, std::uint64_t count) const;
  [[nodiscard]] static PtpReply PropertyDescription(std::uint16_t property);
  PtpReply PolledEvents(std::int64_t now_ms);

  PtpCameraOptions options_;
  std::map<std::uint32_t, Object> objects_;  ///< files by handle
  std::size_t exposures_ = 0;
  int busy_replies_ = 0;
  struct Announcement {
    std::int64_t at_ms;
    PtpEvent event;
  };
  std::vector<Announcement> for_pipe_, for_polling_;
};

}  // namespace striae::testing
