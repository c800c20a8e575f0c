#include "store/detail/trail.h"

#include <algorithm>
#include <tuple>

namespace striae::store::detail {
namespace {

using nlohmann::json;

bool Older(const Step& a, const Step& b) {
  return std::tie(a.utc, a.position.origin, a.position.sequence) <
         std::tie(b.utc, b.position.origin, b.position.sequence);
}

/// The changes of one field that no other change of it stands above, oldest first.
std::vector<Step> Highest(const std::vector<Step>& changes, const Knowledge& knowledge) {
  std::vector<Step> highest;
  for (const Step& step : changes) {
    const bool below = std::any_of(changes.begin(), changes.end(),
                                   [&](const Step& other) { return knowledge.Knew(other.position, step.position); });
    if (!below) highest.push_back(step);
  }
  std::sort(highest.begin(), highest.end(), Older);
  return highest;
}

}  // namespace

Knowledge::Knowledge(Database& database) {
  database.Each(
      "SELECT origin, sequence, new_value FROM audit WHERE entity = 'merge' AND action = 'note' ORDER BY origin, "
      "sequence",
      [&](const RowView& row) {
        const json heads = json::parse(row.Text(2), nullptr, false);
        Merge merge{row.Integer(1), {}};
        if (!heads.is_object()) return;
        for (const auto& [origin, sequence] : heads.items()) {
          if (sequence.is_number_integer()) merge.heads[origin] = sequence.get<std::int64_t>();
        }
        merges_[row.Text(0)].push_back(std::move(merge));
      });
}

bool Knowledge::Knew(const Position& later, const Position& earlier) const {
  if (later.origin == earlier.origin) return later.sequence > earlier.sequence;
  const auto merges = merges_.find(later.origin);
  if (merges == merges_.end()) return false;
  return std::any_of(merges->second.begin(), merges->second.end(), [&](const Merge& merge) {
    const auto head = merge.heads.find(earlier.origin);
    return merge.sequence < later.sequence && head != merge.heads.end() && head->second >= earlier.sequence;
  });
}

Step ReadStep(const RowView& row) {
  return {
      {row.Text(0), row.Integer(1)}, row.Text(2), row.Text(3), row.Text(4), json::parse(row.Text(5), nullptr, false)};
}

TrailState StateOf(std::vector<Step> steps, const Knowledge& knowledge) {
  TrailState state;
  std::map<std::string, std::vector<Step>> changes;
  for (Step& step : steps) {
    if (step.action == "change") {
      changes[step.field].push_back(std::move(step));
    } else if (step.action == "create" && (state.row.is_null() || Older(step, state.created))) {
      state.created = std::move(step);
      state.row = state.created.value;
    }
  }
  if (!state.row.is_object()) return state;
  for (const auto& [field, all] : changes) {
    std::vector<Step> highest = Highest(all, knowledge);
    if (highest.empty()) continue;
    state.row[field] = highest.back().value;
    const bool differ = std::any_of(highest.begin(), highest.end(),
                                    [&](const Step& step) { return step.value != highest.back().value; });
    if (differ) state.clashes.push_back({field, std::move(highest)});
  }
  return state;
}

TrailState StateOf(Database& database, const std::string& table, const std::string& id, const Knowledge& knowledge) {
  return StateOf(
      database.Rows(std::string(kSteps) + "FROM audit WHERE entity = ? AND entity_id = ?", ReadStep, table, id),
      knowledge);
}

}  // namespace striae::store::detail
