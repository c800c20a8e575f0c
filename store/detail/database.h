// One connection to study.db: settings, prepared statements, and the way from rows to values. Throws Failed or
// SQLite::Exception; Guarded converts both.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "core/hex.h"
#include "core/id.h"
#include "core/time.h"
#include "store/detail/failed.h"

namespace striae::store::detail {

/// What a column holds. STRICT tables keep it so.
using Value = std::variant<std::monostate, std::int64_t, double, std::string>;

/// Text that is valid UTF-8 without NUL: wrong bytes become U+FFFD. File names and EXIF strings can hold anything.
std::string CleanText(std::string_view text);

inline Value ToValue(std::string_view text) { return CleanText(text); }
inline Value ToValue(const char* text) { return CleanText(text); }
inline Value ToValue(const std::string& text) { return CleanText(text); }
inline Value ToValue(std::int64_t number) { return number; }
inline Value ToValue(std::uint64_t number) { return static_cast<std::int64_t>(number); }
inline Value ToValue(int number) { return std::int64_t{number}; }
inline Value ToValue(double number) { return number; }
inline Value ToValue(const Value& value) { return value; }
inline Value ToValue(const Sha256& sha256) { return sha256.ToString(); }
inline Value ToValue(const UtcTime& time) { return time.ToString(); }
inline Value ToValue(const Date& date) { return date.ToString(); }
template <typename Tag>
Value ToValue(const Id<Tag>& id) {
  return id.ToString();
}
template <typename T>
Value ToValue(const std::optional<T>& value) {
  return value ? ToValue(*value) : Value{};
}

/// The row that a statement stands on.
class RowView {
 public:
  explicit RowView(SQLite::Statement& statement) : statement_(&statement) {}
  [[nodiscard]] bool IsNull(int column) const { return statement_->getColumn(column).isNull(); }
  [[nodiscard]] std::string Text(int column) const { return statement_->getColumn(column).getString(); }
  [[nodiscard]] std::optional<std::string> OptionalText(int column) const {
    return IsNull(column) ? std::nullopt : std::optional(Text(column));
  }
  [[nodiscard]] std::int64_t Integer(int column) const { return statement_->getColumn(column).getInt64(); }
  [[nodiscard]] double Real(int column) const { return statement_->getColumn(column).getDouble(); }
  [[nodiscard]] UtcTime Time(int column) const { return Unwrap(UtcTime::Parse(Text(column))); }
  [[nodiscard]] Date Day(int column) const { return Unwrap(Date::Parse(Text(column))); }
  [[nodiscard]] Sha256 Hash(int column) const { return Unwrap(Sha256::Parse(Text(column))); }
  template <typename IdType>
  [[nodiscard]] IdType Key(int column) const {
    return Unwrap(IdType::Parse(Text(column)));
  }
  [[nodiscard]] int size() const { return statement_->getColumnCount(); }
  [[nodiscard]] std::string NameOf(int column) const { return statement_->getColumnName(column); }
  [[nodiscard]] Value ValueOf(int column) const;

 private:
  SQLite::Statement* statement_;
};

class Database {
 public:
  /// Opens an existing file, or makes it. WAL, synchronous=FULL and foreign keys are set by Configure.
  Database(const std::filesystem::path& file, bool create);
  void Configure();
  void SetBusyTimeout(std::chrono::milliseconds wait);
  /// Called once, when another program's lock makes this one wait.
  void WhenBusy(std::function<void()> tell) { busy_->tell = std::move(tell); }

  void Execute(const std::string& sql) { sqlite_.exec(sql); }
  [[nodiscard]] std::int64_t UserVersion();

  /// All rows of a prepared query, read by `read(RowView)`. The statement is released before this returns, so that no
  /// reader keeps an old state of the file in view.
  template <typename Read, typename... Arguments>
  auto Rows(const std::string& sql, Read read, const Arguments&... arguments) {
    std::vector<decltype(read(std::declval<RowView>()))> rows;
    SQLite::Statement& statement = Bind(sql, {ToValue(arguments)...});
    const Release release(statement);
    while (statement.executeStep()) rows.push_back(read(RowView(statement)));
    return rows;
  }
  /// Calls `visit(RowView)` for one row after the other. No other use of the same query meanwhile.
  template <typename Visit, typename... Arguments>
  void Each(const std::string& sql, Visit visit, const Arguments&... arguments) {
    SQLite::Statement& statement = Bind(sql, {ToValue(arguments)...});
    const Release release(statement);
    while (statement.executeStep()) visit(RowView(statement));
  }
  /// The first row, or nothing.
  template <typename Read, typename... Arguments>
  auto One(const std::string& sql, Read read, const Arguments&... arguments)
      -> std::optional<decltype(read(std::declval<RowView>()))> {
    SQLite::Statement& statement = Bind(sql, {ToValue(arguments)...});
    const Release release(statement);
    if (!statement.executeStep()) return std::nullopt;
    return read(RowView(statement));
  }
  template <typename... Arguments>
  std::int64_t Count(const std::string& sql, const Arguments&... arguments) {
    return One(
               sql, [](const RowView& row) { return row.Integer(0); }, arguments...)
        .value_or(0);
  }
  void Run(const std::string& sql, const std::vector<Value>& values);

 private:
  struct Release {
    explicit Release(SQLite::Statement& s) : statement(s) {}
    ~Release() { statement.tryReset(); }
    Release(const Release&) = delete;
    Release& operator=(const Release&) = delete;
    SQLite::Statement& statement;
  };
  SQLite::Statement& Bind(const std::string& sql, const std::vector<Value>& values);

  /// Has one place for SQLite's callback, wherever the Database is moved.
  struct Busy {
    std::chrono::milliseconds patience{0};
    std::function<void()> tell;
    std::int64_t waited_ms = 0;
  };
  static int OnBusy(void* busy, int calls);

  std::unique_ptr<Busy> busy_ = std::make_unique<Busy>();
  SQLite::Database sqlite_;
  std::unordered_map<std::string, std::unique_ptr<SQLite::Statement>> statements_;
};

}  // namespace striae::store::detail
