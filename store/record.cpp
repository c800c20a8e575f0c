#include "store/record.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>

#include "store/detail/keep.h"
#include "store/detail/schema.h"
#include "store/detail/words.h"
#include "store/pseudonym.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDatabaseName = "study.db";
constexpr const char* kNewDatabaseName = ".study.db.new";  // until the first transaction is complete
constexpr const char* kObjectsName = "objects";

void RefuseUnlessFree(const fs::path& folder) {
  if (fs::exists(folder / kDatabaseName)) {
    Refuse(ErrorCode::kRecordRefused,
           folder.string() + " holds a study already; use it with -C, or choose a new folder");
  }
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) Refuse(ErrorCode::kUsage, folder.string() + " is a file; name a new folder");
  for (const auto& entry : fs::directory_iterator(folder)) {
    // What an init that was killed can have left.
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kNewDatabaseName) || (name == kObjectsName && fs::is_empty(entry.path()))) continue;
    Refuse(ErrorCode::kRecordRefused, folder.string() + " is not empty (" + name + "); choose a new folder");
  }
}

void RemoveNew(const fs::path& folder) {
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(folder / (std::string(kNewDatabaseName) + suffix), ignored);
  }
}

void WriteFirstRows(const fs::path& file, const Study& study, const Site& site, const Uuid& origin,
                    const Stamp& stamp) {
  Database database(file, true);
  database.Configure();
  database.Execute("PRAGMA application_id=" + std::to_string(detail::kApplicationId));
  detail::Migrate(database, detail::Migrations());
  Change change(database, stamp);
  database.Run("INSERT INTO this_copy (only_row, origin) VALUES (1, ?)", {ToValue(origin.ToString())});
  change.Insert("study", {{"id", ToValue(study.id)},
                          {"protocol", ToValue(study.protocol)},
                          {"title", ToValue(study.title)},
                          {"sponsor", ToValue(study.sponsor)},
                          {"coordinating_centre", ToValue(study.coordinating_centre)},
                          {"subject_pattern", study.subject_pattern.empty() ? Value{} : ToValue(study.subject_pattern)},
                          {"check_digit", study.check_digit.empty() ? Value{} : ToValue(study.check_digit)}});
  detail::InsertSite(change, site);
  change.Commit();
  database.Execute("PRAGMA journal_mode=WAL");  // stays with the file
}

/// SQLite says "disk I/O error" or "readonly database"; what a person can do something about is looked up.
Error Explained(Error error, const fs::path& folder) {
  for (const fs::path& path : {folder, folder / kDatabaseName, folder / kObjectsName}) {
    const int wanted = R_OK | W_OK | (fs::is_directory(path) ? X_OK : 0);
    if (::access(path.c_str(), wanted) == 0) continue;
    error.message = path.string() + " cannot be written by this user (" + std::strerror(errno) +
                    "); reading needs it too, for the log beside study.db: ask who keeps the study, or work on a "
                    "restored backup (striae restore). " +
                    error.message;
    return error;
  }
  constexpr std::uintmax_t kLeast = 256 * 1024;  // study.db-shm and the log of a small change
  std::error_code code;
  if (fs::space(folder, code).available < kLeast && !code) {
    error.message = "no room is left on the disk of " + folder.string() + ": make room, then repeat. " + error.message;
  }
  return error;
}

}  // namespace

Record::Record(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Record::Record(Record&&) noexcept = default;
Record& Record::operator=(Record&&) noexcept = default;
Record::~Record() = default;

const fs::path& Record::folder() const { return impl_->folder; }
const ObjectStore& Record::objects() const { return impl_->objects; }
void Record::WhenBusy(std::function<void()> tell) { impl_->database.WhenBusy(std::move(tell)); }

Result<Record> Record::Create(const fs::path& folder, const Study& study, const Site& site, const Uuid& origin,
                              const Stamp& stamp) {
  const Status made = detail::Guarded([&] {
    if (study.protocol.empty() || site.code.empty()) {
      Refuse(ErrorCode::kUsage, "a study needs a protocol number and a site; give --protocol and --site");
    }
    detail::Unwrap(CheckPattern(study.subject_pattern, study.check_digit));
    RefuseUnlessFree(folder);
    std::error_code code;
    fs::create_directories(folder, code);
    if (!fs::is_directory(folder)) {
      Refuse(ErrorCode::kIo, "cannot make " + folder.string() + " (" + code.message() + "); check the permissions");
    }
    RemoveNew(folder);
    detail::Unwrap(ObjectStore::Open(folder / kObjectsName));
    try {
      WriteFirstRows(folder / kNewDatabaseName, study, site, origin, stamp);
      // A link does not overwrite: of two programs that make the same study, one is told.
      fs::create_hard_link(folder / kNewDatabaseName, folder / kDatabaseName, code);
      if (code) fs::rename(folder / kNewDatabaseName, folder / kDatabaseName);
    } catch (...) {
      RemoveNew(folder);
      throw;
    }
    RemoveNew(folder);
  });
  if (!made) return Fail(made.error());
  return Open(folder, stamp);
}

Result<Record> Record::Open(const fs::path& folder, const Stamp& stamp) {
  auto opened = detail::Guarded([&] {
    const fs::path file = folder / kDatabaseName;
    if (!fs::exists(file)) {
      Refuse(ErrorCode::kNotFound,
             "no study in " + (folder.empty() ? fs::path(".") : folder).string() +
                 " (study.db is not there); name its folder with -C, or make one with 'striae init'");
    }
    Database database(file, false);
    database.Configure();
    const std::int64_t before = database.UserVersion();
    detail::BringUpToDate(database, file, detail::Migrations());
    if (database.UserVersion() != before) {
      Change change(database, stamp);
      change.Note("study.db", "format", std::to_string(before), std::to_string(database.UserVersion()));
      change.Commit();
    }
    auto objects = detail::Unwrap(ObjectStore::Open(folder / kObjectsName));
    return Record(std::unique_ptr<Impl>(new Impl{folder, std::move(objects), std::move(database)}));
  });
  if (!opened && opened.error().code == ErrorCode::kIo) return Fail(Explained(opened.error(), folder));
  return opened;
}

Result<Study> Record::GetStudy() {
  return detail::Guarded([&] {
    const auto read = [](const detail::RowView& row) {
      return Study{row.Key<StudyId>(0),
                   row.Text(1),
                   row.Text(2),
                   row.Text(3),
                   row.Text(4),
                   row.OptionalText(5).value_or(""),
                   row.OptionalText(6).value_or("")};
    };
    auto study = impl_->database.One(
        "SELECT id, protocol, title, sponsor, coordinating_centre, subject_pattern, check_digit FROM study", read);
    if (!study) Refuse(ErrorCode::kRecordDamaged, "study.db names no study; restore a backup");
    return *std::move(study);
  });
}

Result<std::vector<Site>> Record::Sites() {
  return detail::Guarded([&] {
    return impl_->database.Rows("SELECT id, code, name, time_zone FROM site ORDER BY code",
                                [](const detail::RowView& row) {
                                  return Site{row.Key<SiteId>(0), row.Text(1), row.Text(2), row.Text(3)};
                                });
  });
}

}  // namespace striae::store
