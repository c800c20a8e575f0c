#include "acquire/worker/detail/camera.h"

#include <cstdlib>
#include <memory>
#include <utility>

namespace striae::acquire::worker {
namespace {

template <auto Release>
struct Releaser {
  template <typename T>
  void operator()(T* handle) const {
    Release(handle);
  }
};
using AbilitiesList = std::unique_ptr<::CameraAbilitiesList, Releaser<gp_abilities_list_free>>;
using PortList = std::unique_ptr<::GPPortInfoList, Releaser<gp_port_info_list_free>>;
using List = std::unique_ptr<::CameraList, Releaser<gp_list_free>>;
using Widget = std::unique_ptr<::CameraWidget, Releaser<gp_widget_free>>;
using File = std::unique_ptr<::CameraFile, Releaser<gp_file_unref>>;

bool Says(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

/// libgphoto2 gives -1 for every refused trigger; the cause stands in its words alone.
std::string KindOfRefusal(int code, const std::string& text) {
  if (Says(text, "Out of Focus")) return "out-of-focus";
  if (Says(text, "Store Full")) return "store-full";
  if (Says(text, "Store Not Available") || Says(text, "Store Read Only")) return "no-card";
  if (code == GP_ERROR_CAMERA_BUSY || Says(text, "Device Busy")) return "busy";
  if (code == GP_ERROR_IO || code == GP_ERROR_TIMEOUT || code == GP_ERROR_IO_READ || code == GP_ERROR_IO_WRITE)
    return "link";
  return "refused";
}

}  // namespace

Camera::Camera(std::function<void()> on_progress) : on_progress_(std::move(on_progress)), context_(gp_context_new()) {
  gp_context_set_error_func(context_, &Camera::OnError, this);
  gp_context_set_progress_funcs(context_, &Camera::OnStart, &Camera::OnUpdate, nullptr, this);
  gp_camera_new(&camera_);
}

Camera::~Camera() {
  if (open_) gp_camera_exit(camera_, context_);  // gives -6 after a good session; nothing follows from it
  gp_camera_unref(camera_);
  gp_context_unref(context_);
}

void Camera::OnError(::GPContext* /*context*/, const char* text, void* self) {
  static_cast<Camera*>(self)->said_ = text == nullptr ? "" : text;
}
unsigned Camera::OnStart(::GPContext* /*context*/, float /*target*/, const char* /*text*/, void* self) {
  static_cast<Camera*>(self)->on_progress_();
  return 1;
}
void Camera::OnUpdate(::GPContext* /*context*/, unsigned /*id*/, float /*current*/, void* self) {
  static_cast<Camera*>(self)->on_progress_();
}

Failure Camera::Failed(std::string kind, int code) const {
  const std::string words = said_.empty() ? gp_result_as_string(code) : said_;
  return {std::move(kind), code, words};
}

Failure Camera::Choose(const std::string& model, const std::string& port, ::CameraAbilitiesList* abilities,
                       ::GPPortInfoList* ports) {
  const int driver = gp_abilities_list_lookup_model(abilities, model.c_str());
  const int place = gp_port_info_list_lookup_path(ports, port.c_str());
  if (driver < 0) return Failed("absent", driver);
  if (place < 0) return {"link", place, "there is no port " + port};
  ::CameraAbilities ability;
  ::GPPortInfo info = nullptr;
  gp_abilities_list_get_abilities(abilities, driver, &ability);
  gp_port_info_list_get_info(ports, place, &info);
  gp_camera_set_abilities(camera_, ability);
  const int code = gp_camera_set_port_info(camera_, info);
  return code < 0 ? Failed("link", code) : Failure{};
}

Failure Camera::ChooseUsb(const std::string& port, ::CameraAbilitiesList* abilities, ::GPPortInfoList* ports) {
  ::CameraList* raw = nullptr;
  gp_list_new(&raw);
  const List found(raw);
  const int code = gp_abilities_list_detect(abilities, ports, found.get(), context_);
  if (code < 0) return Failed("absent", code);
  std::string others;
  for (int i = 0; i < gp_list_count(found.get()); ++i) {
    const char *model = nullptr, *place = nullptr;
    gp_list_get_name(found.get(), i, &model);
    gp_list_get_value(found.get(), i, &place);
    if (model == nullptr || place == nullptr || (!port.empty() && port != place)) continue;
    if (Says(model, "D90")) return Choose(model, place, abilities, ports);
    others += (others.empty() ? "found: " : ", ") + std::string(model);
  }
  return {others.empty() ? "absent" : "wrong-model", 0, others};
}

Failure Camera::Open(const std::string& port) {
  said_.clear();
  ::CameraAbilitiesList* raw_abilities = nullptr;
  ::GPPortInfoList* raw_ports = nullptr;
  gp_abilities_list_new(&raw_abilities);
  gp_port_info_list_new(&raw_ports);
  const AbilitiesList abilities(raw_abilities);
  const PortList ports(raw_ports);
  gp_abilities_list_load(abilities.get(), context_);
  gp_port_info_list_load(ports.get());
  const bool network = port.rfind("ptpip:", 0) == 0;
  Failure chosen = network ? Choose("PTP/IP Camera", port, abilities.get(), ports.get())
                           : ChooseUsb(port, abilities.get(), ports.get());
  if (!chosen.kind.empty()) return chosen;
  const int code = gp_camera_init(camera_, context_);
  open_ = code >= 0;
  if (open_) return {};
  const bool claimed = code == GP_ERROR_IO_USB_CLAIM || code == GP_ERROR_IO_LOCK;
  return Failed(claimed ? "claimed" : network ? "link" : "absent", code);
}

std::string Camera::Setting(const char* name) {
  ::CameraWidget* raw = nullptr;
  if (gp_camera_get_single_config(camera_, name, &raw, context_) < 0) return "";
  const Widget widget(raw);
  const char* value = nullptr;
  return gp_widget_get_value(widget.get(), &value) < 0 || value == nullptr ? "" : value;
}

Failure Camera::UseCard() {
  said_.clear();
  ::CameraWidget* raw = nullptr;
  int code = gp_camera_get_single_config(camera_, "capturetarget", &raw, context_);
  if (code < 0) return Failed("no-card-target", code);
  const Widget widget(raw);
  code = gp_widget_set_value(widget.get(), "Memory card");
  if (code >= 0) code = gp_camera_set_single_config(camera_, "capturetarget", widget.get(), context_);
  return code < 0 ? Failed("no-card-target", code) : Failure{};
}

Failure Camera::Trigger() {
  said_.clear();
  const int code = gp_camera_trigger_capture(camera_, context_);
  if (code >= 0) return {};
  return Failed(KindOfRefusal(code, said_), code);
}

Failure Camera::Wait(int milliseconds, Event& event, FileName& file) {
  said_.clear();
  event = Event::kNone;
  ::CameraEventType type = GP_EVENT_TIMEOUT;
  void* raw = nullptr;
  const int code = gp_camera_wait_for_event(camera_, milliseconds, &type, &raw, context_);
  const std::unique_ptr<void, Releaser<std::free>> data(raw);
  if (code == GP_ERROR_CAMERA_BUSY) return {};  // one busy answer to polling ends the wait; it is asked again
  if (code < 0) return Failed("link", code);
  if (type == GP_EVENT_FILE_ADDED && raw != nullptr) {
    const auto* path = static_cast<const ::CameraFilePath*>(raw);
    file = {path->folder, path->name};
    event = Event::kFile;
  } else if (type == GP_EVENT_CAPTURE_COMPLETE) {
    event = Event::kComplete;
  } else if (type != GP_EVENT_TIMEOUT) {
    event = Event::kOther;
  }
  return {};
}

Failure Camera::Fetch(const FileName& file, std::vector<std::uint8_t>& bytes) {
  said_.clear();
  ::CameraFileInfo info;
  int code = gp_camera_file_get_info(camera_, file.folder.c_str(), file.name.c_str(), &info, context_);
  if (code < 0) return Failed("transfer", code);
  ::CameraFile* raw = nullptr;
  gp_file_new(&raw);
  const File memory(raw);
  code =
      gp_camera_file_get(camera_, file.folder.c_str(), file.name.c_str(), GP_FILE_TYPE_NORMAL, memory.get(), context_);
  if (code < 0) return Failed("transfer", code);
  const char* data = nullptr;
  unsigned long size = 0;
  code = gp_file_get_data_and_size(memory.get(), &data, &size);
  if (code < 0) return Failed("transfer", code);
  const bool size_known = (info.file.fields & GP_FILE_INFO_SIZE) != 0;
  if (!size_known || info.file.size != size) {
    return {"short", 0, std::to_string(size) + " of " + std::to_string(info.file.size) + " bytes"};
  }
  bytes.assign(data, data + size);
  return {};
}

}  // namespace striae::acquire::worker
