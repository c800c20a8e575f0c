#include "app/study.h"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>

#include <pwd.h>
#include <sodium.h>
#include <unistd.h>

#include "store/as_of.h"

namespace striae::app {
namespace {

/// Who uses this program is a property of the process.
std::string& Operator() {
  static std::string name;
  return name;
}

std::string UserName() {
  if (!Operator().empty()) return Operator();
  if (const char* name = std::getenv("STRIAE_USER"); name != nullptr && *name != '\0') return name;
  if (const passwd* entry = ::getpwuid(::geteuid()); entry != nullptr) return entry->pw_name;
  return "uid " + std::to_string(::geteuid());
}

std::string MachineName() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string("unknown");
}

/// The IANA name where the system tells it: TZ, else what /etc/localtime leads to.
std::string ZoneName() {
  if (const char* zone = std::getenv("TZ"); zone != nullptr && *zone != '\0') return zone;
  std::error_code code;
  const std::string target = std::filesystem::read_symlink("/etc/localtime", code).string();
  constexpr std::string_view kFolder = "zoneinfo/";
  const auto at = target.find(kFolder);
  return at == std::string::npos ? std::string() : target.substr(at + kFolder.size());
}

}  // namespace

void ActAs(const std::string& user) { Operator() = user; }

store::Stamp NewStamp() {
  using std::chrono::system_clock;
  const system_clock::time_point now = system_clock::now();
  const std::time_t seconds = system_clock::to_time_t(now);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  store::Stamp stamp;
  stamp.now.unix_ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count();
  stamp.user = UserName();
  stamp.machine = MachineName();
  stamp.zone = ZoneName();
  stamp.utc_offset_min = static_cast<int>(local.tm_gmtoff / 60);
  return stamp;
}

Uuid NewUuid() {
  std::array<std::uint8_t, 16> random{};
  randombytes_buf(random.data(), random.size());
  return Uuid::FromRandom(random);
}

Result<store::Record> OpenStudy(const Context& context) {
  auto record = store::Record::Open(context.study, NewStamp());
  if (record) {
    record->WhenBusy([] { std::cerr << "waiting: another program is writing to this study\n"; });
  }
  return record;
}

Result<store::Record> OpenStudyAsOf(const Context& context, const std::string& utc) {
  auto record = OpenStudy(context);
  if (!record || utc.empty()) return record;
  // A day alone means its end.
  const auto instant = UtcTime::Parse(utc.size() == 10 ? utc + "T23:59:59.999Z" : utc);
  if (!instant) return Fail(ErrorCode::kUsage, "--as-of is a time in UTC: 2026-05-04T12:00:00Z");
  return store::AsOf(*record, *instant);
}

Result<store::Record::Found> FindTarget(store::Record& record, const std::string& text) {
  if (text != "study") return record.Find(text);
  const auto study = record.GetStudy();
  if (!study) return Fail(study.error());
  return store::Record::Found{"study", study->id.ToString()};
}

Result<SessionId> ParseSessionId(const std::string& text) {
  auto id = SessionId::Parse(text);
  if (!id) {
    return Fail(ErrorCode::kNotFound,
                "no session '" + text.substr(0, 40) +
                    "'; 'striae session list' shows the ids (36 characters) of this study's sessions");
  }
  return id;
}

Result<Capture> FindCapture(store::Record& record, const std::string& text) {
  const auto found = record.Find(text);
  if (!found) return Fail(found.error());
  if (found->entity == "object") {
    const auto sha256 = Sha256::Parse(found->id);
    if (!sha256) return Fail(sha256.error());
    const auto captures = record.CapturesOf(*sha256);
    if (captures && captures->size() == 1) return captures->front();
  }
  if (found->entity != "capture") {
    return Fail(ErrorCode::kNotFound, "'" + text.substr(0, 40) + "' is the id of: " + found->entity +
                                          ", not a capture; see 'striae show SESSION'");
  }
  const auto id = CaptureId::Parse(found->id);
  if (!id) return Fail(id.error());
  return record.CaptureById(*id);
}

}  // namespace striae::app
