// What an entity must be by its audit rows, also where several copies of the study have changed it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/detail/database.h"

namespace striae::store::detail {

/// A row of the trail, by the copy that wrote it and its number there.
struct Position {
  std::string origin;
  std::int64_t sequence = 0;
};

/// What a copy had taken in from the others when it wrote a row: by the notes of its merges. A change that was made
/// with knowledge of another one stands above it, whatever the clocks say (vector clocks: C. J. Fidge, Timestamps in
/// message-passing systems that preserve the partial ordering, Proc. 11th Australian Computer Science Conference,
/// 1988).
class Knowledge {
 public:
  explicit Knowledge(Database& database);
  /// True when who wrote `later` had `earlier` before him.
  [[nodiscard]] bool Knew(const Position& later, const Position& earlier) const;

 private:
  struct Merge {
    std::int64_t sequence = 0;
    std::map<std::string, std::int64_t> heads;
  };
  std::map<std::string, std::vector<Merge>> merges_;
};

/// The audit rows about one entity that make its state.
struct Step {  // NOLINT(bugprone-exception-escape): nlohmann's own noexcept move
  Position position;
  std::string utc, action, field;
  nlohmann::json value;  ///< discarded when the text is no JSON
};

inline constexpr const char* kSteps = "SELECT origin, sequence, utc, action, field, coalesce(new_value, '') ";
Step ReadStep(const RowView& row);

/// Two copies changed the same field without knowing of each other.
struct Clash {
  std::string field;
  std::vector<Step> sides;  ///< oldest first; the last one counts
};

struct TrailState {    // NOLINT(bugprone-exception-escape)
  nlohmann::json row;  ///< an object; null when there is no "create"
  Step created;        ///< the oldest, where two copies made the same row
  std::vector<Clash> clashes;
};

/// `steps` in any order. Of changes that did not know of each other the latest counts (then the greater origin).
TrailState StateOf(std::vector<Step> steps, const Knowledge& knowledge);

/// The state of one entity, read from the trail.
TrailState StateOf(Database& database, const std::string& table, const std::string& id, const Knowledge& knowledge);

}  // namespace striae::store::detail
