#include "store/detail/merge_rows.h"

#include <algorithm>
#include <tuple>

#include "store/detail/codec.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

constexpr const char* kWho = "merge";

Value FromJson(const json& value) {
  if (value.is_null()) return {};
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) return value.get<double>();
  return value.is_string() ? value.get<std::string>() : Dump(value);
}

std::string TextOf(const json& value) { return value.is_string() ? value.get<std::string>() : Dump(value); }

/// Made earlier comes first; the same order in every copy.
std::tuple<std::string, std::string, std::int64_t> BirthOf(const TrailState& state) {
  return {state.created.utc, state.created.position.origin, state.created.position.sequence};
}

}  // namespace

bool UniqueKey::Has(const std::string& column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

std::vector<UniqueKey> UniqueKeysOf(Database& database, const std::string& table) {
  const auto text = [](const RowView& row) { return row.Text(0); };
  std::vector<UniqueKey> keys;
  for (const std::string& name :
       database.Rows("SELECT name FROM pragma_index_list(?) WHERE \"unique\" AND origin <> 'pk'", text, table)) {
    keys.push_back({database.Rows("SELECT name FROM pragma_index_info(?) ORDER BY seqno", text, name)});
  }
  return keys;
}

RowMerger::RowMerger(Database& database, Change& change, MergeReport& report)
    : database_(database), change_(change), report_(report), knowledge_(database) {}

RowMerger::Row RowMerger::Current(const std::string& table, const std::string& id) {
  return RowAsJson(database_, table, id);
}

bool RowMerger::IsLater(const std::string& table, const std::string& a, const std::string& b) {
  return BirthOf(StateOf(database_, table, a, knowledge_)) > BirthOf(StateOf(database_, table, b, knowledge_));
}

void RowMerger::Query(const std::string& entity, const std::string& id, const std::string& key, const std::string& text,
                      const std::string& at) {
  report_.queries.push_back(entity + " " + id + ": " + text);
  const std::string query = UuidFrom({"merge", entity, id, key}).ToString();
  if (database_.Count("SELECT count(*) FROM data_query WHERE id = ?", query) != 0) return;
  change_.Insert("data_query", {{"id", query},
                                {"entity", ToValue(entity)},
                                {"entity_id", ToValue(id)},
                                {"text", ToValue(text)},
                                {"by", ToValue(kWho)},
                                {"at", ToValue(at)}});
}

void RowMerger::Place(const std::string& table, const std::string& id) {
  TrailState state = StateOf(database_, table, id, knowledge_);
  if (!state.row.is_object()) return;
  const Row before = Current(table, id);
  Row row = state.row;
  const auto differs = [&](const auto& item) {
    return !before.contains(item.key()) || before[item.key()] != item.value();
  };
  const auto items = row.items();
  if (before.is_null() || std::any_of(items.begin(), items.end(), differs)) {
    MakeRoom(table, row);
    Write(table, row, before.is_null());
    (before.is_null() ? report_.rows : report_.updated) += 1;
    for (const auto& [column, value] : row.items()) {
      const bool settled_later = column == "number" || column == "supersedes";
      if (value != state.row[column] && !settled_later) {
        change_.Account(table, id, column, state.row[column], value, "merge: it was taken at both copies");
      }
    }
  }
  for (const Clash& clash : state.clashes) {
    if (clash.field == "number" || clash.field == "supersedes") continue;
    std::string key = clash.field, values;
    for (const Step& side : clash.sides) {
      key += " " + side.position.origin + ":" + std::to_string(side.position.sequence);
      values += (values.empty() ? "" : " and ") + TextOf(side.value);
    }
    Query(table, id, key,
          "two copies changed " + clash.field + " without knowing of each other, to " + values +
              "; the last one counts until somebody decides",
          clash.sides.back().utc);
  }
}

void RowMerger::Write(const std::string& table, const Row& row, bool is_new) {
  std::string names, marks, sets;
  std::vector<Value> values;
  for (const auto& [column, value] : row.items()) {
    names += (names.empty() ? "" : ", ") + column;
    marks += marks.empty() ? "?" : ", ?";
    sets += (sets.empty() ? "" : ", ") + column + " = ?";
    values.push_back(FromJson(value));
  }
  std::string sql = is_new ? "INSERT INTO " + table : "UPDATE " + table;
  if (is_new) {
    sql.append(" (").append(names).append(") VALUES (").append(marks).append(")");
  } else {
    sql.append(" SET ").append(sets).append(" WHERE id = ?");
    values.push_back(FromJson(row.at("id")));
  }
  database_.Run(sql, values);
}

void RowMerger::MakeRoom(const std::string& table, Row& row) {
  if (!keys_.contains(table)) keys_[table] = UniqueKeysOf(database_, table);
  for (const UniqueKey& key : keys_[table]) {
    std::string sql = "SELECT id FROM " + table;
    sql += " WHERE id <> ?1";
    for (std::size_t i = 0; i < key.columns.size(); ++i) {
      sql.append(" AND ").append(key.columns[i]).append(" = ?").append(std::to_string(i + 2));
    }
    const auto value = [&](std::size_t i) {
      return i < key.columns.size() ? FromJson(row.value(key.columns[i], Row())) : Value{};
    };
    const auto id = [](const RowView& view) { return view.Text(0); };
    const auto other = key.columns.size() == 1   ? database_.One(sql, id, FromJson(row.at("id")), value(0))
                       : key.columns.size() == 2 ? database_.One(sql, id, FromJson(row.at("id")), value(0), value(1))
                                                 : std::nullopt;
    if (other) Meet(table, key, row, *other);
  }
}

void RowMerger::Meet(const std::string& table, const UniqueKey& key, Row& row, const std::string& other_id) {
  if (key.Has("number") && key.columns.size() == 2) {
    const std::string& column = key.columns[key.columns[0] == "number" ? 1 : 0];
    const std::string parent = TextOf(row.at(column));
    std::string sql = "SELECT max(number) FROM " + table;
    sql += " WHERE " + column + " = ?";
    original_number_[TextOf(row.at("id"))] = row.at("number").get<std::int64_t>();
    row["number"] = 1 + database_.Count(sql, parent);
    renumber_.insert({table, {column, parent}});
  } else if (key.Has("supersedes")) {
    row["supersedes"] = nullptr;
    relink_.insert(table);
  } else if (table == "capture" && key.Has("sha256")) {
    MoveDuplicate(row, other_id);
  } else {
    Rename(table, key, row, other_id);
  }
}

void RowMerger::Rename(const std::string& table, const UniqueKey& key, Row& row, const std::string& other_id) {
  const std::string id = TextOf(row.at("id"));
  const auto name = std::find_if(key.columns.begin(), key.columns.end(), [&](const std::string& column) {
    return row.at(column).is_string() &&
           database_.Count("SELECT count(*) FROM pragma_foreign_key_list(?) WHERE \"from\" = ?", table, column) == 0;
  });
  if (name == key.columns.end()) {
    Refuse(ErrorCode::kRecordRefused, "both copies decided on the same thing (" + table + " " + id + " and " +
                                          other_id + "); this cannot be merged, nothing was changed");
  }
  const bool row_is_later = IsLater(table, id, other_id);
  const std::string& later = row_is_later ? id : other_id;
  constexpr std::size_t kKept = 23;  // with the suffix a pseudonym's 32 characters
  const std::string old = TextOf(row.at(*name));
  const std::string renamed = old.substr(0, kKept) + "." + later.substr(0, 8);
  if (row_is_later) {
    row[*name] = renamed;
  } else {
    change_.Set(table, other_id, *name, ToValue(renamed), "merge: it was taken at both copies");
  }
  Query(table, later, "name", *name + " " + old + " was given at both copies; the later one is now " + renamed,
        StateOf(database_, table, later, knowledge_).created.utc);
}

void RowMerger::MoveDuplicate(Row& row, const std::string& other_id) {
  const std::string id = TextOf(row.at("id"));
  const bool row_is_later = IsLater("capture", id, other_id);
  const std::string later = row_is_later ? id : other_id;
  const std::string session = TextOf(row.at("session_id"));
  const std::string apart = UuidFrom({"merge", "duplicate", session}).ToString();
  if (Current("session", apart).is_null()) {
    Row copy = StateOf(database_, "session", session, knowledge_).created.value;
    copy["id"] = apart;
    copy["closed_at"] = copy["opened_at"];  // nothing more is added to it
    std::vector<std::string> names = {"id"};
    for (const auto& [column, value] : copy.items()) {
      if (column != "id") names.push_back(column);
    }
    Columns columns;
    for (const std::string& name : names) columns.emplace_back(name.c_str(), FromJson(copy[name]));
    change_.Insert("session", columns, "merge: for photographs that were imported at both copies");
  }
  const std::int64_t number =
      1 + database_.Count("SELECT coalesce(max(number), 0) FROM capture WHERE session_id = ?", apart);
  if (row_is_later) {
    row["session_id"] = apart;
    original_number_[id] = row["number"].get<std::int64_t>();
    row["number"] = number;
  } else {
    original_number_[other_id] = Current("capture", other_id)["number"].get<std::int64_t>();
    database_.Run("UPDATE capture SET number = ?, session_id = ? WHERE id = ?", {number, apart, other_id});
    change_.Account("capture", other_id, "session_id", session, apart, "merge: it was imported at both copies");
  }
  renumber_.insert({"capture", {"session_id", apart}});
  Query("capture", later, "duplicate",
        "this photograph was imported at both copies; this one stands in a session of its own, exclude one of them",
        StateOf(database_, "capture", later, knowledge_).created.utc);
}

void RowMerger::Settle() {
  for (const auto& [table, place] : renumber_) Renumber(table, place.first, place.second);
  for (const std::string& table : relink_) Relink(table);
}

void RowMerger::Renumber(const std::string& table, const std::string& parent_column, const std::string& parent) {
  struct Item {
    std::int64_t wanted, now, by_trail;
    std::tuple<std::string, std::string, std::int64_t> birth;
    std::string id;
  };
  std::string of = " FROM " + table;
  of += " WHERE " + parent_column + " = ?";
  std::vector<Item> items;
  const auto id_of = [](const RowView& row) { return row.Text(0); };
  for (const std::string& id : database_.Rows("SELECT id" + of, id_of, parent)) {
    const TrailState state = StateOf(database_, table, id, knowledge_);
    const auto now = Current(table, id)["number"].get<std::int64_t>();
    const auto original = original_number_.find(id);
    items.push_back({original == original_number_.end() ? now : original->second, now,
                     state.row["number"].get<std::int64_t>(), BirthOf(state), id});
  }
  std::sort(items.begin(), items.end(),
            [](const Item& a, const Item& b) { return std::tie(a.wanted, a.birth) < std::tie(b.wanted, b.birth); });
  std::int64_t last = 0;
  for (Item& item : items) last = item.wanted = std::max(item.wanted, last + 1);
  std::string set = "UPDATE " + table;
  set += " SET number = ? WHERE id = ?";
  for (const Item& item : items) {
    if (item.wanted != item.now) database_.Run(set, {-item.wanted, item.id});  // out of the others' way
  }
  for (const Item& item : items) {
    if (item.wanted != item.now) database_.Run(set, {item.wanted, item.id});
    if (item.wanted != item.by_trail) {
      change_.Account(table, item.id, "number", item.by_trail, item.wanted, "merge: both copies went on counting");
    }
  }
}

void RowMerger::Relink(const std::string& table) {
  // Rows that by the trail supersede the same one stand in a row now, the earlier before the later.
  std::map<std::string, std::vector<std::pair<std::tuple<std::string, std::string, std::int64_t>, std::string>>>
      siblings;
  const auto id_of = [](const RowView& row) { return row.Text(0); };
  for (const std::string& id : database_.Rows("SELECT id FROM " + table, id_of)) {
    const TrailState state = StateOf(database_, table, id, knowledge_);
    const auto before = state.row.value("supersedes", Row());
    if (before.is_string()) siblings[before.get<std::string>()].emplace_back(BirthOf(state), id);
  }
  std::string set = "UPDATE " + table;
  set += " SET supersedes = ? WHERE id = ?";
  std::string next = "SELECT id FROM " + table;
  next += " WHERE supersedes = ?";
  for (auto& [before, all] : siblings) {
    if (all.size() < 2) {
      // It made way for a row that has since been placed elsewhere: its own place is free again.
      const std::string& id = all.front().second;
      if (Current(table, id)["supersedes"] != before) database_.Run(set, {before, id});
      continue;
    }
    std::sort(all.begin(), all.end());
    for (const auto& [birth, id] : all) database_.Run(set, {Value{}, id});
    std::string tail = before;
    for (const auto& [birth, id] : all) {
      database_.Run(set, {tail, id});
      if (tail != before) {
        change_.Account(table, id, "supersedes", before, tail, "merge: both copies went on from the same one");
      }
      tail = id;
      while (const auto newer = database_.One(next, id_of, tail)) tail = *newer;
    }
  }
}

}  // namespace striae::store::detail
