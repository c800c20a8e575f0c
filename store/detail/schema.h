// The tables of study.db and how they came to be: numbered migrations, PRAGMA user_version = the last one applied.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/detail/database.h"

namespace striae::store::detail {

/// SQL that leads from version i to i + 1. Entries are never edited once released, only added.
const std::vector<std::string>& Migrations();

/// Marks study.db as Striae's (PRAGMA application_id): "Stri" in ASCII.
inline constexpr std::int64_t kApplicationId = 0x53747269;

/// Applies what is missing in one transaction. A fresh file has version 0.
void Migrate(Database& database, const std::vector<std::string>& migrations);

/// Brings an existing study.db up to date. Throws Failed: kRecordRefused when the file is newer than `migrations`,
/// kRecordDamaged when it is not a study. Before an older file is changed, it is copied whole to
/// study.db.before-<new version>, which is never overwritten.
void BringUpToDate(Database& database, const std::filesystem::path& file, const std::vector<std::string>& migrations);

}  // namespace striae::store::detail
