// The parts of Check. Each adds what it finds and never stops at the first.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "store/audit.h"
#include "store/check.h"
#include "store/detail/database.h"
#include "store/objects.h"

namespace striae::store::detail {

/// Collects what is wrong; of each kind of place (the first word of `where`) only so many are kept.
class Findings {
 public:
  explicit Findings(CheckReport& report) : report_(report) {}
  void Error(const std::string& where, std::string what) { Add(Finding::Severity::kError, where, std::move(what)); }
  void Warning(const std::string& where, std::string what) { Add(Finding::Severity::kWarning, where, std::move(what)); }
  /// Says how many were not kept.
  void Close();
  CheckReport& report() { return report_; }

 private:
  void Add(Finding::Severity severity, const std::string& where, std::string what);
  CheckReport& report_;
  std::map<std::string, std::size_t> counts_;
};

/// SQLite's own structure and foreign keys.
void CheckDatabase(Database& database, Findings& findings);
/// Tables, indexes and the triggers that guard them are those of this format.
void CheckSchema(Database& database, Findings& findings);
/// The chain of each origin: numbering, hashes, times; the expected heads must be part of it.
void CheckChain(Database& database, const CheckOptions& options, Findings& findings);
/// Every row of every table is what its audit rows say, none is missing and none is without them.
void CheckRowsAgainstTrail(Database& database, const Progress& progress, Findings& findings);
/// Every object is there with its content; nothing lies in objects/ that the record does not know.
void CheckObjects(Database& database, const ObjectStore& objects, const Progress& progress, Findings& findings);
/// identity.striae is whole, and one that the trail knows.
void CheckIdentities(Database& database, const std::filesystem::path& study, Findings& findings);
/// Files that a program which was stopped has left beside the record.
void CheckLeftovers(const std::filesystem::path& study, Findings& findings);

/// Unfinished files in the study's folder and its quarantine (not in objects/), sorted.
std::vector<std::filesystem::path> Leftovers(const std::filesystem::path& study);

}  // namespace striae::store::detail
