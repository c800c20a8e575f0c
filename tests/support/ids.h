// Ids for tests that need some id, not a particular one.
#pragma once

#include <cstdint>

#include "core/id.h"

namespace striae::testing {

/// The same seed gives the same id.
template <typename T>
T SomeId(std::uint8_t seed) {
  Uuid uuid;
  uuid.bytes.fill(seed);
  return T(uuid);
}

}  // namespace striae::testing
