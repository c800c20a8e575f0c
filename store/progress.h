// How far a long task has come, for a bar on a terminal.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace striae::store {

/// Called now and then with what is done, of how many, and what they are ("objects"). Empty: nobody looks.
using Progress = std::function<void(std::size_t done, std::size_t all, std::string_view what)>;

}  // namespace striae::store
