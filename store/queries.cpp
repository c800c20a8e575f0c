// Queries: a question about the data, its answer, its closing.
#include <array>

#include "store/annotations.h"
#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kQueries = "SELECT id, entity, entity_id, text, by, at, state FROM data_query_now";

QueryState StateFrom(const std::string& text) {
  for (const QueryState state : {QueryState::kAnswered, QueryState::kClosed}) {
    if (ToString(state) == text) return state;
  }
  return QueryState::kOpen;
}

DataQuery ReadQuery(const RowView& row) {
  return {row.Key<QueryId>(0), {row.Text(1), row.Text(2)}, row.Text(3), row.Text(4),
          row.Time(5),         StateFrom(row.Text(6)),     {}};
}

bool CanFollow(QueryState now, QueryState next) {
  if (next == QueryState::kAnswered) return now == QueryState::kOpen;
  if (next == QueryState::kClosed) return now != QueryState::kClosed;
  return now != QueryState::kOpen;
}

}  // namespace

std::string_view ToString(QueryState state) {
  switch (state) {
    case QueryState::kOpen:
      return "open";
    case QueryState::kAnswered:
      return "answered";
    case QueryState::kClosed:
      return "closed";
  }
  throw std::logic_error("QueryState");
}

Status OpenQuery(Record& record, const QueryId& id, const Record::Found& about, const std::string& text,
                 const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireText(text, "a query");
    Change change(Access::Of(record).database, stamp);
    detail::Unwrap(record.Find(about.id));
    change.Insert("data_query", {{"id", ToValue(id)},
                                 {"entity", ToValue(about.entity)},
                                 {"entity_id", ToValue(about.id)},
                                 {"text", ToValue(text)},
                                 {"by", ToValue(stamp.user)},
                                 {"at", ToValue(stamp.now)}});
    change.Commit();
  });
}

Status StepQuery(Record& record, const QueryId& id, QueryState next, const std::string& text, const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireText(text, "an answer, a closing and a re-opening");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    const auto query = database.One(std::string(kQueries) + " WHERE id = ?", ReadQuery, id);
    if (!query) Refuse(ErrorCode::kNotFound, "no query " + id.ToString() + " in this study; see 'striae query list'");
    if (!CanFollow(query->state, next)) {
      Refuse(ErrorCode::kRecordRefused, "this query is " + std::string(ToString(query->state)) + "; it cannot become " +
                                            std::string(ToString(next)) + " from there");
    }
    const auto number = detail::NextNumber(database, "query_step", "query_id", id.ToString());
    const Uuid step =
        detail::UuidFrom({"query step", id.ToString(), std::to_string(number), stamp.now.ToString(), stamp.user, text});
    change.Insert("query_step",
                  {{"id", ToValue(step.ToString())},
                   {"query_id", ToValue(id)},
                   {"number", number},
                   {"state", ToValue(ToString(next))},
                   {"text", ToValue(text)},
                   {"by", ToValue(stamp.user)},
                   {"at", ToValue(stamp.now)}},
                  text);
    change.Commit();
  });
}

Result<std::vector<DataQuery>> Queries(Record& record, bool with_closed, std::optional<std::string> about) {
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    auto queries = database.Rows(
        std::string(kQueries) + " WHERE (?1 OR state <> 'closed') AND (?2 IS NULL OR entity_id = ?2) ORDER BY at, id",
        ReadQuery, with_closed ? 1 : 0, about);
    for (DataQuery& query : queries) {
      query.steps = database.Rows(
          "SELECT state, text, by, at FROM query_step WHERE query_id = ? ORDER BY number, id",
          [](const RowView& row) {
            return QueryStep{StateFrom(row.Text(0)), row.Text(1), row.Text(2), row.Time(3)};
          },
          query.id);
    }
    return queries;
  });
}

}  // namespace striae::store
