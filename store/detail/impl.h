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

namespace detail {

/// For the parts of the record that are free functions: users, visits, queries, ...
struct Access {
  static Record::Impl& Of(Record& record) { return *record.impl_; }
  static Record Make(Record::Impl impl) { return Record(std::make_unique<Record::Impl>(std::move(impl))); }
};

}  // namespace detail

}  // namespace striae::store
