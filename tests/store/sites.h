// A study and its branch at another site, and what the two differ in.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "store/backup.h"
#include "store/detail/database.h"
#include "store/detail/schema.h"
#include "store/merge.h"
#include "tests/store/findings.h"

namespace striae::testing {

namespace fs = std::filesystem;
using store::detail::Database;
using store::detail::RowView;

/// Every row of every table with a trail, as text. Numbers and links included; audit rows are compared by the chains.
inline std::map<std::string, std::string> ContentOf(const fs::path& study) {
  Database database(study / "study.db", false);
  std::map<std::string, std::string> content;
  for (const std::string& table : store::detail::AuditedTables(database)) {
    database.Each("SELECT * FROM " + table, [&](const RowView& row) {
      std::string& text = content[table + " " + row.Text(0)];
      for (int i = 0; i < row.size(); ++i) text += row.NameOf(i) + "=" + row.OptionalText(i).value_or("NULL") + "|";
    });
  }
  return content;
}

/// The differences, for a person.
inline std::string Compare(const fs::path& a, const fs::path& b) {
  const auto left = ContentOf(a), right = ContentOf(b);
  std::string text;
  for (const auto& [key, value] : left) {
    const auto other = right.find(key);
    if (other == right.end()) text += "only left: " + key + " " + value + "\n";
    if (other != right.end() && other->second != value) text += key + ":\n  " + value + "\n  " + other->second + "\n";
  }
  for (const auto& [key, value] : right) {
    if (!left.contains(key)) text += "only right: " + key + " " + value + "\n";
  }
  return text;
}

/// A study with a subject and an open session, and its branch.
class Sites {
 public:
  Sites() {
    subject_ = study_.EnrolWithConsent("S001");
    session_ = study_.Open(subject_);
    capture_ = study_.Import(session_, "a photograph", "unassigned");
    outcome_ = *study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
    study_.Close();
    Copy(study_.folder(), "a", std::nullopt);
    Copy(study_.folder(), "b", CountedUuid());
  }
  [[nodiscard]] fs::path At(const std::string& name) const { return study_.dir() / name; }
  void Copy(const fs::path& from, const std::string& name, std::optional<Uuid> branch) {
    store::RestoreOptions options;
    options.branch = branch;
    const auto restored = store::Restore(from, At(name), options, NextStamp());
    if (!restored) throw std::runtime_error(restored.error().Describe());
  }
  [[nodiscard]] store::Record Open(const std::string& name) const {
    auto record = store::Record::Open(At(name), NextStamp());
    if (!record) throw std::runtime_error(record.error().Describe());
    return *std::move(record);
  }
  store::MergeReport Merge(const std::string& into, const std::string& other) {
    auto mine = Open(into), theirs = Open(other);
    auto report = store::Merge(mine, theirs, {}, NextStamp());
    if (!report) throw std::runtime_error(report.error().Describe());
    const auto check = mine.Check();
    if (!check || !check->Passed()) {
      std::string text = "after the merge the check fails:";
      for (const auto& finding : check->findings) text += "\n" + finding.where + " " + finding.what;
      throw std::runtime_error(text);
    }
    return *report;
  }
  /// a takes in b, and in fresh copies b takes in a; then what differs.
  std::string BothWays() {
    Copy(At("a"), "a2", std::nullopt);
    Copy(At("b"), "b2", std::nullopt);
    Merge("a", "b");
    Merge("b2", "a2");
    return Compare(At("a"), At("b2"));
  }

  Subject subject_;
  Session session_;
  Capture capture_;
  store::Outcome outcome_;
  SmallStudy study_;
};

inline void Enrol(store::Record& record, const std::string& pseudonym) {
  const Subject subject{CountedId<SubjectId>(), pseudonym, record.Sites()->front().id, {}, {}};
  ASSERT_THAT(record.AddSubject(subject, NextStamp()), IsOk());
  ASSERT_THAT(record.GiveConsent(subject.id, {2026, 5, 1}, NextStamp()), IsOk());
}

}  // namespace striae::testing
