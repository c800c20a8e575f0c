// The words that the sources of store/ are written in. For .cpp files in store/ only: nothing public includes it.
#pragma once

#include "store/detail/change.h"
#include "store/detail/impl.h"

namespace striae::store {

using detail::Access;
using detail::Change;
using detail::Database;
using detail::Guarded;
using detail::Refuse;
using detail::RowView;
using detail::ToValue;
using detail::Unwrap;
using detail::Value;

}  // namespace striae::store
