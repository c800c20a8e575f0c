// A PTP/IP camera on a free port of the loopback interface, for tests and for the demonstration.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/ptp_camera.h"

namespace striae::testing {

class PtpResponder {
 public:
  /// Listens at once; serves one initiator after the other until it is destroyed.
  explicit PtpResponder(PtpCameraOptions options);
  ~PtpResponder();
  PtpResponder(const PtpResponder&) = delete;
  PtpResponder& operator=(const PtpResponder&) = delete;

  [[nodiscard]] int port() const { return port_; }
  /// As libgphoto2 wants it: command and event port named both.
  [[nodiscard]] std::string PortName() const;
  /// Operation codes in the order of arrival.
  [[nodiscard]] std::vector<std::uint16_t> Journal() const;
  [[nodiscard]] int CountOf(std::uint16_t operation) const;

 private:
  struct Initiator;
  void Serve();
  void Accept(Initiator& initiator);
  bool ServeRequest(Initiator& initiator);
  bool Answer(Initiator& initiator, std::uint32_t transaction, const PtpReply& reply);

  PtpCamera camera_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<std::uint16_t> journal_;
  std::thread thread_;
};

}  // namespace striae::testing
