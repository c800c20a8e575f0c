#include "tests/support/ptp_responder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace striae::testing {
namespace {

constexpr int kPollMs = 10;
constexpr std::size_t kDataBlock = 65536;

std::int64_t NowMs() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

bool Readable(int socket, int wait_ms) {
  pollfd poll_for{socket, POLLIN, 0};
  return ::poll(&poll_for, 1, wait_ms) > 0;
}

void Close(int& socket) {
  if (socket >= 0) ::close(socket);
  socket = -1;
}

}  // namespace

struct PtpResponder::Initiator {
  int command = -1, event = -1;
  bool stalled = false;
  void Leave() {
    Close(command);
    Close(event);
    stalled = false;
  }
  ~Initiator() { Leave(); }
};

PtpResponder::PtpResponder(PtpCameraOptions options) : camera_(std::move(options)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = 0;  // any free one
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (listener_ < 0 || ::bind(listener_, generic, size) != 0 || ::listen(listener_, 4) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("PtpResponder: no port on the loopback interface");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { Serve(); });
}

PtpResponder::~PtpResponder() {
  stop_ = true;
  thread_.join();
  Close(listener_);
}

std::string PtpResponder::PortName() const {
  return "ptpip:127.0.0.1:" + std::to_string(port_) + ":" + std::to_string(port_);
}

std::vector<std::uint16_t> PtpResponder::Journal() const {
  const std::lock_guard lock(mutex_);
  return journal_;
}

int PtpResponder::CountOf(std::uint16_t operation) const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::count(journal_.begin(), journal_.end(), operation));
}

void PtpResponder::Serve() {
  Initiator initiator;
  while (!stop_) {
    if (Readable(listener_, initiator.command < 0 ? kPollMs : 0)) Accept(initiator);
    if (initiator.command < 0) continue;
    if (Readable(initiator.command, kPollMs)) {
      // A stalled camera reads nothing more; it only notices that the other side has gone.
      std::array<char, 1> byte{};
      const bool gone = initiator.stalled && ::recv(initiator.command, byte.data(), 1, MSG_PEEK) <= 0;
      if (gone || (!initiator.stalled && !ServeRequest(initiator))) initiator.Leave();
    }
    if (initiator.event < 0 || initiator.stalled) continue;
    for (const auto& event : camera_.DueEvents(NowMs())) {
      PtpWriter writer;
      writer.U16(event.code).U32(0).U32(event.parameter);
      SendPacket(initiator.event, PacketType::kEvent, writer.bytes);
    }
  }
}

void PtpResponder::Accept(Initiator& initiator) {
  int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) return;
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  const auto packet = ReceivePacket(socket);
  if (packet && packet->type == PacketType::kInitCommandRequest) {
    initiator.Leave();  // a new initiator replaces one that was killed
    initiator.command = socket;
    PtpWriter ack;
    ack.U32(1).U32(0).U32(0).U32(0).U32(0);  // connection number, GUID
    for (const char c : {'D', '9', '0', '\0'}) ack.U16(static_cast<unsigned char>(c));
    ack.U32(0x00010000);
    SendPacket(socket, PacketType::kInitCommandAck, ack.bytes);
  } else if (packet && packet->type == PacketType::kInitEventRequest && initiator.event < 0) {
    initiator.event = socket;
    SendPacket(socket, PacketType::kInitEventAck, {});
  } else {
    Close(socket);
  }
}

bool PtpResponder::ServeRequest(Initiator& initiator) {
  const auto packet = ReceivePacket(initiator.command);
  if (!packet) return false;
  if (packet->type != PacketType::kRequest) return true;
  const std::uint16_t operation = ReadU16(packet->payload, 4);
  const std::uint32_t transaction = ReadU32(packet->payload, 6);
  std::vector<std::uint32_t> parameters;
  for (std::size_t at = 10; at + 4 <= packet->payload.size(); at += 4) {
    parameters.push_back(ReadU32(packet->payload, at));
  }
  {
    const std::lock_guard lock(mutex_);
    journal_.push_back(operation);
  }
  PtpBytes data_in;
  if (operation == 0x1016) {  // the only operation in use that sends data to the camera
    while (true) {
      const auto data = ReceivePacket(initiator.command);
      if (!data) return false;
      if (data->type != PacketType::kStartData && data->payload.size() > 4) {
        data_in.insert(data_in.end(), data->payload.begin() + 4, data->payload.end());
      }
      if (data->type == PacketType::kEndData) break;
    }
  }
  const PtpReply reply = camera_.Handle(operation, parameters, data_in, NowMs());
  if (reply.stalls) initiator.stalled = true;
  return Answer(initiator, transaction, reply);
}

bool PtpResponder::Answer(Initiator& initiator, std::uint32_t transaction, const PtpReply& reply) {
  if (reply.has_data) {
    PtpWriter start;
    start.U32(transaction).U64(reply.data.size());
    if (!SendPacket(initiator.command, PacketType::kStartData, start.bytes)) return false;
    const std::size_t end = reply.stalls ? reply.data.size() / 2 : reply.data.size();
    for (std::size_t sent = 0; sent < end || (end == 0 && sent == 0);) {
      const std::size_t size = std::min(kDataBlock, end - sent);
      const bool last = sent + size == reply.data.size();
      PtpWriter block;
      block.U32(transaction);
      block.bytes.insert(block.bytes.end(), reply.data.begin() + static_cast<std::ptrdiff_t>(sent),
                         reply.data.begin() + static_cast<std::ptrdiff_t>(sent + size));
      if (!SendPacket(initiator.command, last ? PacketType::kEndData : PacketType::kData, block.bytes)) return false;
      sent += size;
      if (size == 0) break;
    }
  }
  if (reply.stalls) return true;
  PtpWriter response;
  response.U16(reply.code).U32(transaction);
  for (const auto parameter : reply.parameters) response.U32(parameter);
  return SendPacket(initiator.command, PacketType::kResponse, response.bytes);
}

}  // namespace striae::testing
