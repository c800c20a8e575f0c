// Holds every #include against the house's table: app -> {acquire, reconstruct, analysis, store, dicom, report} ->
// core, and no third-party type in a public header.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace striae {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>>& AllowedParts() {
  static const std::map<std::string, std::set<std::string>> table = {
      {"core", {}},
      {"acquire", {"core"}},
      {"reconstruct", {"core"}},
      {"analysis", {"core"}},
      {"store", {"core"}},
      {"dicom", {"core"}},
      {"report", {"core"}},
      {"app", {"core", "acquire", "reconstruct", "analysis", "store", "dicom", "report"}}};
  return table;
}

/// What a public header may use besides the standard library and core: values, no library's handle.
const std::set<std::string>& PublicThirdParty() {
  static const std::set<std::string> names = {"Eigen/Core", "Eigen/Geometry", "nlohmann/json.hpp", "tl/expected.hpp"};
  return names;
}

struct Include {
  std::string name;
  bool quoted = false;
};

std::vector<Include> IncludesOf(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  std::ifstream stream(file);
  std::vector<Include> includes;
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) includes.push_back({match[2], match[1] == "\""});
  }
  return includes;
}

bool IsPublicHeader(const fs::path& relative) {
  for (const auto& part : relative) {
    if (part == "detail") return false;
  }
  return relative.extension() == ".h";
}

std::vector<fs::path> SourcesOf(const std::string& part) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(STRIAE_SOURCE_DIR) / part)) {
    const auto extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp" || extension == ".in") files.push_back(entry.path());
  }
  return files;
}

std::string PartOf(const std::string& include) { return include.substr(0, include.find('/')); }

/// Why an include may not stand in a file of `part`; empty when it may.
std::string Objection(const std::string& part, bool public_header, const Include& include) {
  const std::string target = PartOf(include.name);
  const bool ours = AllowedParts().contains(target) || target == "tests";
  if (include.quoted && !ours) return "is not written from the project's root";
  if (ours && target != part && !AllowedParts().at(part).contains(target)) return "is not in the table for " + part;
  const bool standard = include.name.find('.') == std::string::npos && include.name.find('/') == std::string::npos;
  if (public_header && part != "app" && !ours && !standard && !PublicThirdParty().contains(include.name)) {
    return "is a library's type in a public header";
  }
  return {};
}

TEST(Architecture, EveryIncludeStandsInTheTable) {
  for (const auto& [part, allowed] : AllowedParts()) {
    const auto files = SourcesOf(part);
    EXPECT_FALSE(files.empty()) << part;
    for (const auto& file : files) {
      const fs::path relative = file.lexically_relative(STRIAE_SOURCE_DIR);
      for (const Include& include : IncludesOf(file)) {
        EXPECT_EQ(Objection(part, IsPublicHeader(relative), include), "") << relative << " includes " << include.name;
      }
    }
  }
}

TEST(Architecture, TheTableObjectsToWhatItMust) {
  EXPECT_NE(Objection("store", false, {"dicom/export.h", true}), "");
  EXPECT_NE(Objection("core", false, {"store/record.h", true}), "");
  EXPECT_NE(Objection("store", true, {"sqlite3.h", false}), "");
  EXPECT_NE(Objection("report", false, {"../core/result.h", true}), "");
  EXPECT_EQ(Objection("store", false, {"sqlite3.h", false}), "");
  EXPECT_EQ(Objection("app", false, {"dicom/export.h", true}), "");
  EXPECT_EQ(Objection("core", true, {"vector", false}), "");
}

TEST(Architecture, NoSourceFileNamesAFolderOfSomebodysMachine) {
  const std::regex private_path(R"((^|[^\w.])/(home|root|work|Users)/)");
  for (const char* part : {"core", "acquire", "reconstruct", "analysis", "store", "dicom", "report", "app", "tests"}) {
    for (const auto& file : SourcesOf(part)) {
      if (file.filename() == "includes_test.cpp") continue;
      std::ifstream stream(file);
      int number = 0;
      for (std::string line; std::getline(stream, line);) {
        ++number;
        EXPECT_FALSE(std::regex_search(line, private_path)) << file << ":" << number << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace striae
