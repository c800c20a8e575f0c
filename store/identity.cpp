#include "store/identity.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sodium.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/detail/change.h"
#include "store/detail/database.h"
#include "store/detail/disk.h"
#include "store/detail/impl.h"
#include "store/detail/sealed.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;
using detail::Refuse;

/// A database in memory that leaves nothing in files of its own.
class MemoryDatabase {
 public:
  MemoryDatabase() {
    if (sqlite3_open(":memory:", &connection_) != SQLITE_OK) throw std::bad_alloc();
    Run("PRAGMA temp_store=MEMORY; PRAGMA secure_delete=ON");
  }
  ~MemoryDatabase() { sqlite3_close(connection_); }
  MemoryDatabase(const MemoryDatabase&) = delete;
  MemoryDatabase& operator=(const MemoryDatabase&) = delete;

  void Run(const char* sql) { Expect(sqlite3_exec(connection_, sql, nullptr, nullptr, nullptr), SQLITE_OK); }
  void Expect(int result, int expected) const {
    // No text of SQLite's: it could quote what is in the rows.
    if (result != expected) Refuse(ErrorCode::kRecordDamaged, "identity.striae holds a database that cannot be read");
  }
  [[nodiscard]] sqlite3* get() const { return connection_; }

 private:
  sqlite3* connection_ = nullptr;
};

class Statement {
 public:
  Statement(MemoryDatabase& database, const char* sql) : database_(database) {
    database.Expect(sqlite3_prepare_v2(database.get(), sql, -1, &statement_, nullptr), SQLITE_OK);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  void Bind(int index, const std::string& text) {
    const std::string clean = detail::CleanText(text);
    database_.Expect(
        sqlite3_bind_text(statement_, index, clean.c_str(), static_cast<int>(clean.size()), SQLITE_TRANSIENT),
        SQLITE_OK);
  }
  [[nodiscard]] bool Step() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_DONE) database_.Expect(result, SQLITE_ROW);
    return result == SQLITE_ROW;
  }
  [[nodiscard]] std::string Text(int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text == nullptr ? std::string() : std::string(text);
  }

 private:
  MemoryDatabase& database_;
  sqlite3_stmt* statement_ = nullptr;
};

void Fill(MemoryDatabase& database, const std::vector<Identity>& identities) {
  database.Run(
      "CREATE TABLE person (subject_id TEXT PRIMARY KEY NOT NULL, pseudonym TEXT NOT NULL, name TEXT NOT NULL, "
      "birth_date TEXT NOT NULL, hospital_id TEXT NOT NULL, changed_at TEXT NOT NULL, changed_by TEXT NOT NULL) "
      "STRICT; PRAGMA user_version=1");
  for (const Identity& person : identities) {
    Statement insert(database, "INSERT INTO person VALUES (?, ?, ?, ?, ?, ?, ?)");
    insert.Bind(1, person.subject.ToString());
    insert.Bind(2, person.pseudonym);
    insert.Bind(3, person.name);
    insert.Bind(4, person.birth_date ? person.birth_date->ToString() : "");
    insert.Bind(5, person.hospital_id);
    insert.Bind(6, person.changed_at.ToString());
    insert.Bind(7, person.changed_by);
    if (insert.Step()) Refuse(ErrorCode::kInternal, "identity.striae could not be filled");
  }
}

std::vector<Identity> ReadAll(MemoryDatabase& database) {
  std::vector<Identity> all;
  Statement select(database,
                   "SELECT subject_id, pseudonym, name, birth_date, hospital_id, changed_at, changed_by FROM person "
                   "ORDER BY pseudonym, subject_id");
  while (select.Step()) {
    Identity person;
    person.subject = detail::Unwrap(SubjectId::Parse(select.Text(0)));
    person.pseudonym = select.Text(1);
    person.name = select.Text(2);
    if (!select.Text(3).empty()) person.birth_date = detail::Unwrap(Date::Parse(select.Text(3)));
    person.hospital_id = select.Text(4);
    person.changed_at = detail::Unwrap(UtcTime::Parse(select.Text(5)));
    person.changed_by = select.Text(6);
    all.push_back(std::move(person));
  }
  return all;
}

/// Temporary file, fsync, `account`, rename over the old one, fsync of the folder.
template <typename Account>
void Replace(const fs::path& file, std::span<const std::uint8_t> bytes, Account account) {
  std::string name = file.string() + ".part-XXXXXX";
  {
    const detail::File draft(::mkostemp(name.data(), O_CLOEXEC));
    if (draft.get() < 0) detail::RefuseIo("write in", file.parent_path(), errno);
    try {
      detail::WriteWhole(draft.get(), file, bytes);
      if (::fchmod(draft.get(), 0600) != 0) detail::RefuseIo("write", file, errno);
      account();
      if (std::rename(name.c_str(), file.c_str()) != 0) detail::RefuseIo("write", file, errno);
    } catch (...) {
      ::unlink(name.c_str());
      throw;
    }
  }
  detail::SyncFolder(file.parent_path().empty() ? fs::path(".") : file.parent_path());
}

std::vector<std::uint8_t> SealAll(const std::vector<Identity>& identities, std::string_view passphrase,
                                  const IdentityRandom& random, const IdentityCost& cost) {
  if (passphrase.size() < kShortestPassphrase) {
    Refuse(ErrorCode::kUsage, "the passphrase is too short: at least " + std::to_string(kShortestPassphrase) +
                                  " characters, better four random words");
  }
  MemoryDatabase database;
  Fill(database, identities);
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(database.get(), "main", &size, 0);
  if (bytes == nullptr) throw std::bad_alloc();
  const auto length = static_cast<std::size_t>(size);
  sodium_mlock(bytes, length);  // refused where the system's limit is low; the file is protected all the same
  std::vector<std::uint8_t> sealed;
  try {
    sealed = detail::Seal({bytes, length}, passphrase, random, cost);
  } catch (...) {
    sodium_munlock(bytes, length);  // wipes
    sqlite3_free(bytes);
    throw;
  }
  sodium_munlock(bytes, length);
  sqlite3_free(bytes);
  return sealed;
}

/// One program at a time changes the file. The lock is on the folder itself: it leaves nothing behind and goes with the
/// program, however that ends.
class Turn {
 public:
  explicit Turn(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_.get() < 0) detail::RefuseIo("open", folder, errno);
    constexpr int kTries = 1200;
    for (int i = 0; ::flock(folder_.get(), LOCK_EX | LOCK_NB) != 0; ++i) {
      if (errno != EWOULDBLOCK) return;  // a file system without locks
      if (i == kTries) {
        Refuse(ErrorCode::kIo, std::string("another program is changing ") + kIdentityName +
                                   "; wait until it has finished, then repeat");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

 private:
  detail::File folder_;
};

}  // namespace

Result<std::vector<Identity>> ReadIdentities(const fs::path& file, std::string_view passphrase) {
  return detail::Guarded([&] {
    if (!fs::exists(file)) return std::vector<Identity>{};
    const detail::SecretBytes plain = detail::Unseal(detail::ReadWhole(file), passphrase);
    MemoryDatabase database;
    database.Expect(sqlite3_deserialize(database.get(), "main", plain.data(), static_cast<sqlite3_int64>(plain.size()),
                                        static_cast<sqlite3_int64>(plain.size()), SQLITE_DESERIALIZE_READONLY),
                    SQLITE_OK);
    return ReadAll(database);
  });
}

Status WriteIdentities(const fs::path& file, const std::vector<Identity>& identities, std::string_view passphrase,
                       const IdentityRandom& random, const IdentityCost& cost) {
  return detail::Guarded([&] { Replace(file, SealAll(identities, passphrase, random, cost), [] {}); });
}

Status ChangeIdentities(Record& record, const IdentityChange& change, const Stamp& stamp) {
  return detail::Guarded([&] {
    const fs::path file = record.folder() / kIdentityName;
    const Turn turn(record.folder());
    auto people = detail::Unwrap(ReadIdentities(file, change.passphrase));
    detail::Unwrap(change.edit(people));
    const bool again = change.new_passphrase.empty();
    const auto sealed = SealAll(people, again ? change.passphrase : change.new_passphrase, change.random, change.cost);
    Replace(file, sealed, [&] {
      detail::Change row(detail::Access::Of(record).database, stamp);
      row.Note(kIdentityName, again ? "set" : "passphrase", "", HashOf(sealed).ToString());
      row.Commit();
    });
  });
}

Status CheckIdentityFile(const fs::path& file) {
  return detail::Guarded([&] { detail::CheckSealed(detail::ReadWhole(file)); });
}

}  // namespace striae::store
