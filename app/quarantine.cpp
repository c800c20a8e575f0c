#include "app/quarantine.h"

#include <algorithm>
#include <filesystem>

#include "app/io/files.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNoteEnding = ".why.json";

/// Somebody has imported the same bytes since.
bool IsInRecord(store::Record& record, const std::string& sha256) {
  const auto digest = Sha256::Parse(sha256);
  if (!digest) return false;
  const auto captures = record.CapturesOf(*digest);
  return captures && !captures->empty();
}

}  // namespace

std::vector<QuarantinedFile> Quarantined(store::Record& record) {
  std::vector<QuarantinedFile> files;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(record.folder() / "quarantine", absent)) {
    QuarantinedFile file;
    file.name = entry.path().filename().string();
    if (file.name.ends_with(kNoteEnding) || file.name.starts_with('.')) continue;
    const auto text = ReadText(entry.path().string() + std::string(kNoteEnding));
    const auto note = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    const auto word = [&](const char* key) {
      const auto found = note.is_object() ? note.find(key) : note.end();
      return note.is_object() && found != note.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    if (IsInRecord(record, word("sha256"))) continue;
    file.origin = word("origin");
    file.message = note.is_object() ? word("message") : "the note beside it is missing or cannot be read";
    files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return files;
}

nlohmann::json ToJson(const std::vector<QuarantinedFile>& files) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& file : files) {
    list.push_back({{"file", file.name}, {"origin", file.origin}, {"message", file.message}});
  }
  return list;
}

std::string TextOf(const std::vector<QuarantinedFile>& files) {
  if (files.empty()) return {};
  constexpr std::size_t kMost = 10;
  std::string text = "\nin quarantine (look at them, import what is whole by hand, then remove the file and its note):";
  for (std::size_t i = 0; i < std::min(kMost, files.size()); ++i) {
    text += "\n  quarantine/" + files[i].name + ": " + files[i].message;
  }
  if (files.size() > kMost) text += "\n  and " + std::to_string(files.size() - kMost) + " more";
  return text;
}

}  // namespace striae::app
