// What a Record holds.
#pragma once

#include "store/detail/database.h"
#include "store/record.h"

namespace striae::store {

struct Record::Impl {
  std::filesystem::path folder;
  ObjectStore objects;
  detail::Database database;
};

}  // namespace striae::store
