#include "store/repair.h"

#include <algorithm>
#include <system_error>

#include <unistd.h>

#include "store/check.h"
#include "store/detail/check.h"
#include "store/detail/codec.h"
#include "store/detail/disk.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;

class Repairer {
 public:
  Repairer(Record::Impl& study, const RepairOptions& options, const Stamp& stamp)
      : study_(study), options_(options), stamp_(stamp), quarantine_(study.folder / "quarantine") {}

  std::vector<Repaired> Run() {
    BringBackObjects();
    for (const fs::path& path : detail::Leftovers(study_.folder)) SettleLeftover(path);
    SetAsideStrangers();
    // The log is part of the file from here on; SQLite has replayed it when the study was opened.
    study_.database.Execute("PRAGMA wal_checkpoint(TRUNCATE)");
    return std::move(repaired_);
  }

 private:
  void Note(const std::string& where, const std::string& what) {
    Change change(study_.database, stamp_);
    change.Note("repair", where, "", what);
    change.Commit();
    repaired_.push_back({where, what});
  }
  [[nodiscard]] std::string NameOf(const fs::path& path) const {
    return path.lexically_relative(study_.folder).string();
  }

  /// To quarantine/<first digits of its SHA-256>-<name>, with the reason beside it.
  void SetAside(const fs::path& path, const std::string& why) {
    const Sha256 sha256 = detail::HashFile(path);
    detail::MakeFolder(quarantine_);
    std::string name = path.filename().string();
    // Not a name that looks unfinished again.
    name.erase(0, name.find_first_not_of('.'));
    std::replace(name.begin(), name.end(), '.', '_');
    const std::string beginning = sha256.ToString().substr(0, 12) + "-" + name;
    fs::path kept = quarantine_ / beginning;
    for (int copy = 2; fs::exists(kept); ++copy) kept = quarantine_ / (beginning + "-" + std::to_string(copy));
    Note(NameOf(path), "moved to " + NameOf(kept) + ": " + why);
    const nlohmann::json note = {{"origin", NameOf(path)},
                                 {"sha256", sha256.ToString()},
                                 {"size_bytes", fs::file_size(path)},
                                 {"reason", "repair"},
                                 {"message", why},
                                 {"at", stamp_.now.ToString()}};
    const std::string text = detail::Dump(note) + "\n";
    const fs::path why_file = kept.string() + ".why.json";
    if (!fs::exists(why_file)) {
      detail::WriteNew(why_file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }
    detail::MoveNew(path, kept);
  }

  void Remove(const fs::path& path, const std::string& why) {
    Note(NameOf(path), "removed: " + why);
    ::unlink(path.c_str());
  }

  void SettleLeftover(const fs::path& path) {
    const std::string name = path.filename().string();
    // Drafts of study.db hold nothing: the first was never a study (or is the same file), the others are copies of it.
    const bool draft = name.starts_with(".study.db.new") || name.starts_with("study.db.before-");
    if (draft || fs::file_size(path) == 0) {
      Remove(path, draft ? "an unfinished copy of study.db" : "empty");
    } else {
      SetAside(path, "unfinished: its program was stopped");
    }
  }

  void SetAsideStrangers() {
    for (int part = 0; part < 256; ++part) {
      const auto listing = Unwrap(study_.objects.ListPart(static_cast<std::uint8_t>(part)));
      for (const fs::path& path : listing.strangers) SettleLeftover(path);
      for (const Sha256& sha256 : listing.objects) {
        if (study_.database.Count("SELECT count(*) FROM object WHERE id = ?", sha256) != 0) continue;
        SetAside(study_.objects.PathOf(sha256), "an object without a row; import the file again");
      }
    }
  }

  /// A file here that has these very bytes, whatever its name.
  [[nodiscard]] std::optional<fs::path> FindBytes(const Sha256& sha256, std::uint64_t size) const {
    std::vector<fs::path> places = detail::Leftovers(study_.folder);
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(quarantine_, absent)) places.push_back(entry.path());
    for (const auto& entry : fs::directory_iterator(study_.objects.folder())) places.push_back(entry.path());
    if (options_.from) {
      const std::string name = sha256.ToString();
      places.push_back(*options_.from / "objects" / name.substr(0, 2) / name.substr(2));
    }
    for (const fs::path& path : places) {
      std::error_code code;
      if (fs::is_regular_file(path, code) && fs::file_size(path, code) == size && detail::HashFile(path) == sha256) {
        return path;
      }
    }
    return std::nullopt;
  }

  void BringBackObjects() {
    struct Object {
      Sha256 sha256;
      std::uint64_t size = 0;
    };
    const auto all = static_cast<std::size_t>(study_.database.Count("SELECT count(*) FROM object"));
    std::size_t done = 0;
    std::vector<Object> lost;
    study_.database.Each("SELECT id, size_bytes FROM object ORDER BY id", [&](const RowView& row) {
      const Object object{row.Hash(0), static_cast<std::uint64_t>(row.Integer(1))};
      if (!study_.objects.Verify(object.sha256)) lost.push_back(object);
      if (options_.progress) options_.progress(++done, all, "objects");
    });
    for (const Object& object : lost) {
      const auto found = FindBytes(object.sha256, object.size);
      if (!found) continue;  // Check goes on naming it
      if (study_.objects.Has(object.sha256)) SetAside(study_.objects.PathOf(object.sha256), "damaged");
      Note("object " + object.sha256.ToString(), "brought back from " + found->string());
      Unwrap(study_.objects.PutFile(*found, object.sha256));
    }
  }

  Record::Impl& study_;
  const RepairOptions& options_;
  Stamp stamp_;
  fs::path quarantine_;
  std::vector<Repaired> repaired_;
};

}  // namespace

Result<std::vector<Repaired>> Repair(Record& record, const RepairOptions& options, const Stamp& stamp) {
  Record::Impl& study = detail::Access::Of(record);
  // Otherwise what another program is just writing would look like a leftover.
  if (auto alone = study.objects.TakeAlone(); !alone) return Fail(alone.error());
  auto result = Guarded([&] { return Repairer(study, options, stamp).Run(); });
  study.objects.Share();
  return result;
}

}  // namespace striae::store
