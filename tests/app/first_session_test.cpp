// README's first page, typed as it stands there: the commands are taken out of README.md itself.
#include <algorithm>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_data.h"

namespace striae::testing {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The lines of README's block under "## A first session".
std::vector<std::string> ReadmeCommands() {
  std::istringstream readme(ReadText(std::filesystem::path(STRIAE_SOURCE_DIR) / "README.md"));
  std::vector<std::string> commands;
  bool section = false, block = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.starts_with("## ")) section = line == "## A first session";
    if (!section) continue;
    if (line == "```") block = !block;
    if (block && line != "```") commands.push_back(line);
  }
  return commands;
}

/// What differs from run to run, by what it is.
std::string Masked(std::string text) {
  const std::pair<const char*, const char*> masks[] = {
      {"[0-9a-f]{64}", "<sha256>"},
      {"[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}", "<id>"},
      {R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)", "<time>"},
      {R"(/\S*/striae-test-\w+)", "HOME"}};
  for (const auto& [what, mask] : masks) text = std::regex_replace(text, std::regex(what), mask);
  return text;
}

class FirstSession : public ::testing::Test {
 protected:
  /// A home folder with a card's photograph, the rig's calibration and an outline.
  void SetUp() override {
    STRIAE_NEED_DATA("practice/wound_0/visit_0.jpg");
    WriteBytes(dir_ / "home/DCIM/100NCD90/DSC_0001.JPG", ReadBytes(TestData("practice/wound_0/visit_0.jpg")));
    WriteBytes(dir_ / "home/small.json", ReadBytes(TestData("practice/true_small.json")));
    const auto truth = nlohmann::json::parse(ReadText(TestData("practice/wound_0/truth.json")));
    const std::string outline = nlohmann::json{{"polygon_px", truth.at(0).at("outline_px")}}.dump();
    WriteBytes(dir_ / "home/wounds-outline.json", {outline.begin(), outline.end()});
  }

  /// Types the lines into a shell: what each said on both outputs, under its own line. A line that fails ends all.
  std::vector<std::pair<std::string, std::string>> Type(const std::vector<std::string>& lines) {
    std::string script = "set -eu\nexport HOME='" + (dir_ / "home").string() + "' STRIAE_USER=coordinator\nPATH='" +
                         std::string(STRIAE_BINARY_DIR) + "':\"$PATH\"\ncd \"$HOME\"\n";
    for (std::size_t i = 0; i < lines.size(); ++i) {
      // What a person reads off the page before: the photograph's id, and the file that the outline was drawn into.
      if (lines[i].find("CAPTURE") != std::string::npos) {
        script +=
            "CAPTURE=$(striae show $id --json | sed -n 's/^ *\"id\": \"\\(.*\\)\",$/\\1/p' | head -1)\n"
            "cp ../wounds-outline.json outline.json\n";
      }
      script += "echo '@@" + std::to_string(i) + "'\n" +
                std::regex_replace(lines[i], std::regex("CAPTURE"), "$$CAPTURE") + "\n";
    }
    WriteBytes(dir_ / "typed.sh", {script.begin(), script.end()});
    const Ran ran = RunProgram("/bin/bash", {"-c", "exec bash '" + (dir_ / "typed.sh").string() + "' 2>&1"});
    EXPECT_EQ(ran.exit_code, 0) << ran.out;
    std::vector<std::pair<std::string, std::string>> transcript;
    std::istringstream said(Masked(ran.out));
    for (std::string line; std::getline(said, line);) {
      if (line.starts_with("@@")) {
        transcript.emplace_back(lines[static_cast<std::size_t>(std::stoi(line.substr(2)))], "");
      } else if (!transcript.empty()) {
        transcript.back().second += line + "\n";
      }
    }
    return transcript;
  }
  TempDir dir_;
};

TEST_F(FirstSession, OfTheReadmeWorksAsItStandsThere) {
  const auto lines = ReadmeCommands();
  ASSERT_GT(lines.size(), 12U);
  const auto transcript = Type(lines);
  ASSERT_EQ(transcript.size(), lines.size());
  // What the record says, line by line; what processing, report and DICOM say is tested where they are.
  const std::vector<std::pair<std::string, ::testing::Matcher<std::string>>> expected = {
      {"striae init", Eq("study P-2026-01 in wounds; next: striae -C wounds subject add S001\n")},
      {"striae subject add", Eq("subject S001; next: striae consent S001 --given DATE\n")},
      {"striae consent", Eq("subject S001: consent given 2026-05-04\n")},
      {"striae visit plan add V1", Eq("V1  day 0  window 0,+0\n")},
      {"striae visit plan add V2", Eq("V2  day 14  window -3,+3\n")},
      {"striae device add", HasSubstr("next: striae calibration add cal.json --device 6123456")},
      {"striae calibration add", Eq("calibration of 6123456 in force from 2026-05-01\n")},
      {"id=$(striae session open", Eq("")},
      {"striae import", AllOf(StartsWith("HOME/home/DCIM/100NCD90/DSC_0001.JPG: added as <id> (wound:W1), preflight "),
                              EndsWith("1 added, 0 already there, 0 failed\n"))},
      {"striae status", Eq("P-2026-01  Wound study\n"
                           "1 subjects (1 with active consent), 1 visits, 1 sessions, 1 captures, 0 measurements\n"
                           "pending:\n"
                           "  1 sessions open\n"
                           "  1 wounds without an outline (striae outline)\n"
                           "  1 captures not processed (striae process)\n")},
      {"striae show", AllOf(HasSubstr("file_name: DSC_0001.JPG\n    id: <id>\n"), HasSubstr("role: wound:W1\n"),
                            HasSubstr("sha256: <sha256>\n"), HasSubstr("subject: S001\n"))},
      {"striae results", AllOf(HasSubstr("S001  V1  wound:W1  volume"), HasSubstr("S001  V1  wound:W1  area"))},
      {"striae check", AllOf(HasSubstr("; head "), EndsWith("passed\n"))}};
  for (const auto& [begin, matches] : expected) {
    const auto typed = std::find_if(transcript.begin(), transcript.end(),
                                    [&](const auto& entry) { return entry.first.starts_with(begin); });
    ASSERT_NE(typed, transcript.end()) << "README no longer has: " << begin;
    EXPECT_THAT(typed->second, matches) << "$ " << typed->first;
  }
  const std::string head = ReadText(dir_ / "home/head.txt");
  EXPECT_THAT(head, ::testing::ContainsRegex("[0-9a-f]{64}")) << "the head is outside the study";
}

}  // namespace
}  // namespace striae::testing
