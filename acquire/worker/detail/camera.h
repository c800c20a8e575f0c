// libgphoto2 with its handles owned, its error texts kept, and only the calls that are known to end.
// Never called: gp_camera_capture (hangs for ever on a refused shot), and anything that deletes on the camera.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gphoto2/gphoto2.h>

namespace striae::acquire::worker {

/// What failed, as acquire/tether.cpp knows it, with libgphoto2's code and words.
struct Failure {
  std::string kind;
  int code = 0;
  std::string text;
};

struct FileName {
  std::string folder, name;
  bool operator==(const FileName&) const = default;
};

enum class Event { kNone, kFile, kComplete, kOther };

class Camera {
 public:
  /// `on_progress` is called for every block of a transfer.
  explicit Camera(std::function<void()> on_progress);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  /// Each returns an empty kind when all is well.
  Failure Open(const std::string& port);
  Failure UseCard();
  Failure Trigger();
  /// Waits at most that long. `file` is set for kFile.
  Failure Wait(int milliseconds, Event& event, FileName& file);
  /// The whole file; its size must be what the camera says it is.
  Failure Fetch(const FileName& file, std::vector<std::uint8_t>& bytes);

  [[nodiscard]] std::string Model() { return Setting("cameramodel"); }
  [[nodiscard]] std::string Serial() { return Setting("serialnumber"); }

 private:
  Failure ChooseUsb(const std::string& port, ::CameraAbilitiesList* abilities, ::GPPortInfoList* ports);
  Failure Choose(const std::string& model, const std::string& port, ::CameraAbilitiesList* abilities,
                 ::GPPortInfoList* ports);
  std::string Setting(const char* name);
  Failure Failed(std::string kind, int code) const;
  static void OnError(::GPContext* context, const char* text, void* self);
  static unsigned OnStart(::GPContext* context, float target, const char* text, void* self);
  static void OnUpdate(::GPContext* context, unsigned id, float current, void* self);

  std::function<void()> on_progress_;
  ::GPContext* context_ = nullptr;
  ::Camera* camera_ = nullptr;
  std::string said_;  ///< the last error text of libgphoto2
  bool open_ = false;
};

}  // namespace striae::acquire::worker
