#include "store/detail/database.h"

#include <new>
#include <string_view>

#include <nlohmann/json.hpp>
#include <sqlite3.h>

namespace striae::store::detail {
namespace {

ErrorCode CodeOf(int primary) {
  switch (primary) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return ErrorCode::kRecordDamaged;
    case SQLITE_CONSTRAINT:
      return ErrorCode::kRecordRefused;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return ErrorCode::kIo;
    default:
      return ErrorCode::kInternal;
  }
}

const char* AdviceFor(int primary) {
  switch (primary) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "; another program is writing to this study: wait until it has finished, then repeat";
    case SQLITE_FULL:
      return "; the disk is full: make room, then repeat";
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "; check the folder's permissions and the disk";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "; the file is damaged: keep it as it is and restore a backup beside it";
    default:
      return "";
  }
}

Error FromSqlite(const SQLite::Exception& exception) {
  int primary = exception.getErrorCode() & 0xff;
  // Every query fits the format: where a table or column is not there, the file's own description is damaged.
  if (primary == SQLITE_ERROR && std::string_view(exception.what()).starts_with("no such ")) primary = SQLITE_CORRUPT;
  return {CodeOf(primary), std::string("study.db: ") + exception.what() + AdviceFor(primary), {}};
}

}  // namespace

Error CurrentError() {
  try {
    throw;
  } catch (const Failed& failed) {
    return failed.error;
  } catch (const SQLite::Exception& exception) {
    return FromSqlite(exception);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::kInternal, "not enough memory; close other programs and repeat", {}};
  } catch (const std::logic_error&) {
    throw;  // a programmer's error stays one
  } catch (const nlohmann::json::exception& exception) {
    return {ErrorCode::kRecordDamaged,
            std::string("study.db holds JSON that cannot be read (") + exception.what() + "); run 'striae check'",
            {}};
  } catch (const std::exception& exception) {
    return {ErrorCode::kInternal, std::string("the study record failed: ") + exception.what(), {}};
  }
}

std::string CleanText(std::string_view text) {
  constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
  // nlohmann's serialiser replaces what is not UTF-8; its parser gives the text back without the quotes.
  const std::string quoted =
      nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string clean = nlohmann::json::parse(quoted).get<std::string>();
  for (std::size_t at = clean.find('\0'); at != std::string::npos; at = clean.find('\0', at)) {
    clean.replace(at, 1, kReplacement);
  }
  return clean;
}

Value RowView::ValueOf(int column) const {
  const SQLite::Column cell = statement_->getColumn(column);
  if (cell.isNull()) return {};
  if (cell.isInteger()) return cell.getInt64();
  if (cell.isFloat()) return cell.getDouble();
  return cell.getString();
}

Database::Database(const std::filesystem::path& file, bool create)
    : sqlite_(file.string(), SQLite::OPEN_READWRITE | (create ? SQLite::OPEN_CREATE : 0)) {
  SetBusyTimeout(std::chrono::seconds(10));
}

void Database::Configure() {
  // FULL: a commit is on the disk when it returns, also through a power cut. recursive_triggers: INSERT OR REPLACE
  // fires the triggers against deletion too.
  Execute("PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; PRAGMA recursive_triggers=ON; PRAGMA trusted_schema=OFF");
}

void Database::SetBusyTimeout(std::chrono::milliseconds wait) {
  busy_->patience = wait;
  sqlite3_busy_handler(sqlite_.getHandle(), &Database::OnBusy, busy_.get());
}

int Database::OnBusy(void* state, int calls) {
  Busy& busy = *static_cast<Busy*>(state);
  if (calls == 0) busy.waited_ms = 0;
  if (busy.waited_ms >= busy.patience.count()) return 0;
  constexpr int kStepMs = 20;
  constexpr std::int64_t kTellAfterMs = 500;  // a commit takes less; longer waits are worth a word
  if (busy.waited_ms >= kTellAfterMs && busy.tell) std::exchange(busy.tell, nullptr)();
  busy.waited_ms += sqlite3_sleep(kStepMs);
  return 1;
}

std::int64_t Database::UserVersion() { return Count("PRAGMA user_version"); }

void Database::Run(const std::string& sql, const std::vector<Value>& values) {
  SQLite::Statement& statement = Bind(sql, values);
  const Release release(statement);
  statement.exec();
}

SQLite::Statement& Database::Bind(const std::string& sql, const std::vector<Value>& values) {
  auto& statement = statements_[sql];
  if (!statement) statement = std::make_unique<SQLite::Statement>(sqlite_, sql);
  statement->reset();
  statement->clearBindings();
  int index = 1;
  for (const Value& value : values) {
    std::visit(
        [&](const auto& plain) {
          if constexpr (std::is_same_v<std::decay_t<decltype(plain)>, std::monostate>) {
            statement->bind(index);
          } else {
            statement->bind(index, plain);
          }
        },
        value);
    ++index;
  }
  return *statement;
}

}  // namespace striae::store::detail
