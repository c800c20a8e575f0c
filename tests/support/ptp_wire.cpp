#include "tests/support/ptp_wire.h"

#include <cerrno>

#include <sys/socket.h>
#include <sys/types.h>

namespace striae::testing {
namespace {

bool SendAll(int socket, const PtpBytes& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t now = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

bool ReceiveAll(int socket, PtpBytes& bytes) {
  std::size_t received = 0;
  while (received < bytes.size()) {
    const ssize_t now = ::recv(socket, bytes.data() + received, bytes.size() - received, 0);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    received += static_cast<std::size_t>(now);
  }
  return true;
}

}  // namespace

PtpWriter& PtpWriter::U8(std::uint32_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value));
  return *this;
}
PtpWriter& PtpWriter::U16(std::uint32_t value) { return U8(value & 0xFF).U8((value >> 8) & 0xFF); }
PtpWriter& PtpWriter::U32(std::uint32_t value) { return U16(value & 0xFFFF).U16(value >> 16); }
PtpWriter& PtpWriter::U64(std::uint64_t value) {
  return U32(static_cast<std::uint32_t>(value)).U32(static_cast<std::uint32_t>(value >> 32));
}
PtpWriter& PtpWriter::Text(const std::string& ascii) {
  if (ascii.empty()) return U8(0);
  U8(static_cast<std::uint32_t>(ascii.size() + 1));
  for (const char c : ascii) U16(static_cast<unsigned char>(c));
  return U16(0);
}
PtpWriter& PtpWriter::Array16(const std::vector<std::uint16_t>& values) {
  U32(static_cast<std::uint32_t>(values.size()));
  for (const auto value : values) U16(value);
  return *this;
}
PtpWriter& PtpWriter::Array32(const std::vector<std::uint32_t>& values) {
  U32(static_cast<std::uint32_t>(values.size()));
  for (const auto value : values) U32(value);
  return *this;
}

std::uint16_t ReadU16(const PtpBytes& bytes, std::size_t at) {
  if (at + 2 > bytes.size()) return 0;
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8));
}
std::uint32_t ReadU32(const PtpBytes& bytes, std::size_t at) {
  if (at + 4 > bytes.size()) return 0;
  return ReadU16(bytes, at) | (static_cast<std::uint32_t>(ReadU16(bytes, at + 2)) << 16);
}

bool SendPacket(int socket, PacketType type, const PtpBytes& payload) {
  PtpWriter packet;
  packet.U32(static_cast<std::uint32_t>(payload.size() + 8)).U32(static_cast<std::uint32_t>(type));
  packet.bytes.insert(packet.bytes.end(), payload.begin(), payload.end());
  return SendAll(socket, packet.bytes);
}

std::optional<Packet> ReceivePacket(int socket) {
  PtpBytes header(8);
  if (!ReceiveAll(socket, header)) return std::nullopt;
  const std::uint32_t length = ReadU32(header, 0);
  constexpr std::uint32_t kLongest = 1 << 20;  // nothing that an initiator sends to a camera is longer
  if (length < 8 || length > kLongest) return std::nullopt;
  Packet packet;
  packet.type = static_cast<PacketType>(ReadU32(header, 4));
  packet.payload.resize(length - 8);
  if (!ReceiveAll(socket, packet.payload)) return std::nullopt;
  return packet;
}

}  // namespace striae::testing
