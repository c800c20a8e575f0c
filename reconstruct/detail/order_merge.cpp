#include "reconstruct/detail/order_merge.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace striae::reconstruct::detail {
namespace {

/// Which nodes are reached from each one.
std::vector<std::vector<bool>> Reach(const std::vector<std::vector<std::size_t>>& next) {
  std::vector<std::vector<bool>> reached(next.size());
  for (std::size_t from = 0; from < next.size(); ++from) {
    reached[from].assign(next.size(), false);
    std::vector<std::size_t> open{from};
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (const std::size_t to : next[at]) {
        if (reached[from][to]) continue;
        reached[from][to] = true;
        open.push_back(to);
      }
    }
  }
  return reached;
}

/// Merges what proves to be one by the lines between the groups so far; whether anything was merged.
bool MergeOnce(const std::vector<Link>& links, std::vector<std::int32_t>& group) {
  const auto group_of = [&](int part) { return group[static_cast<std::size_t>(part)]; };
  std::map<std::int32_t, std::size_t> node;
  std::map<std::pair<std::int32_t, std::int32_t>, LitLines> lines;
  for (const Link& link : links) {
    const std::int32_t from = group_of(link.from), to = group_of(link.to);
    if (from == to) continue;
    node.emplace(from, node.size());
    node.emplace(to, node.size());
    lines[{from, to}] += link.lines;
  }
  std::vector<std::vector<std::size_t>> next(node.size());
  for (const auto& [pair, sum] : lines) {
    if (sum.Proven()) next[node[pair.first]].push_back(node[pair.second]);
  }
  const auto reached = Reach(next);
  std::map<std::int32_t, std::int32_t> to;
  for (const auto& [a, i] : node) {
    for (const auto& [b, j] : node) {
      if (b < a && reached[i][j] && reached[j][i]) {
        to.emplace(a, b);  // the least comes first
        break;
      }
    }
  }
  for (std::int32_t& own : group) {
    if (const auto found = to.find(own); found != to.end()) own = found->second;
  }
  return !to.empty();
}

}  // namespace

std::vector<std::int32_t> MergedParts(const std::vector<std::int32_t>& sheet_of_part, const std::vector<Link>& links) {
  std::vector<Link> within;
  std::copy_if(links.begin(), links.end(), std::back_inserter(within), [&](const Link& link) {
    return sheet_of_part[static_cast<std::size_t>(link.from)] == sheet_of_part[static_cast<std::size_t>(link.to)];
  });
  std::vector<std::int32_t> group(sheet_of_part.size());
  std::iota(group.begin(), group.end(), 0);
  while (MergeOnce(within, group)) {
  }
  return group;
}

}  // namespace striae::reconstruct::detail
