// One photograph through the cable: trigger, wait, transfer to memory, check the size. libgphoto2 runs in a worker
// process of its own, because a stalled USB transfer blocks inside it; the parent's watchdog ends the worker.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>

#include "acquire/source.h"

namespace striae::acquire {

struct TetherOptions {
  std::string port;  ///< empty: the D90 on USB; else libgphoto2's port name, "usb:001,004" or "ptpip:HOST:PORT:PORT"
  std::filesystem::path worker;  ///< the program striae-tether-worker
  /// The watchdog's limits. On a body the flash may charge and the card may be slow.
  std::chrono::milliseconds connect{30000};   ///< to open the camera
  std::chrono::milliseconds trigger{15000};   ///< to have the trigger taken or refused, busy answers included
  std::chrono::milliseconds announce{20000};  ///< from trigger to the file's announcement
  std::chrono::milliseconds stall{10000};     ///< without a single block while a file is transferred
};

/// striae-tether-worker beside the running program.
std::filesystem::path WorkerBesideProgram();

/// Takes `shots` photographs for one subject and session, fixed before the first trigger. The card keeps every file:
/// nothing is ever deleted on the camera. All files of a shot (JPEG and NEF) come, each as its own item; a file that
/// was not caused by the trigger (a press on the camera's own button) comes without a binding.
///
/// Errors are kDeviceFailed and say what to do: camera absent, held by another program, not a D90, out of focus, card
/// full or missing, busy, announced too late, transferred short, stalled. After an error no further shot is taken;
/// files that had arrived before it are handed out first.
class TetherSource : public CaptureSource {
 public:
  TetherSource(TetherOptions options, CaptureBinding binding, int shots);
  Result<std::optional<IngestItem>> Next() override;

 private:
  void TakeOne();

  TetherOptions options_;
  CaptureBinding binding_;
  int shots_left_;
  std::deque<IngestItem> arrived_;
  std::optional<Error> failure_;
};

}  // namespace striae::acquire
