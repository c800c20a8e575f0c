// PTP/IP (CIPA DC-005) packets and PTP (ISO 15740) data sets, as bytes. Little-endian throughout.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace striae::testing {

using PtpBytes = std::vector<std::uint8_t>;

/// Appends to a data set.
class PtpWriter {
 public:
  PtpWriter& U8(std::uint32_t value);
  PtpWriter& U16(std::uint32_t value);
  PtpWriter& U32(std::uint32_t value);
  PtpWriter& U64(std::uint64_t value);
  /// Count of characters with the final zero, then UTF-16; an empty text is the one byte 0.
  PtpWriter& Text(const std::string& ascii);
  PtpWriter& Array16(const std::vector<std::uint16_t>& values);
  PtpWriter& Array32(const std::vector<std::uint32_t>& values);
  PtpBytes bytes;
};

std::uint16_t ReadU16(const PtpBytes& bytes, std::size_t at);  ///< 0 outside
std::uint32_t ReadU32(const PtpBytes& bytes, std::size_t at);  ///< 0 outside

enum class PacketType : std::uint32_t {
  kInitCommandRequest = 1,
  kInitCommandAck = 2,
  kInitEventRequest = 3,
  kInitEventAck = 4,
  kInitFail = 5,
  kRequest = 6,
  kResponse = 7,
  kEvent = 8,
  kStartData = 9,
  kData = 10,
  kCancel = 11,
  kEndData = 12,
  kPing = 13,
  kPong = 14,
};

struct Packet {
  PacketType type{};
  PtpBytes payload;  ///< behind length and type
};

/// False when the other side is gone.
bool SendPacket(int socket, PacketType type, const PtpBytes& payload);
/// Blocks until a whole packet is in; nullopt when the other side is gone or sends nonsense.
std::optional<Packet> ReceivePacket(int socket);

}  // namespace striae::testing
