// What holds for every command: help with an example, exit codes, one JSON document, completion.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "app/catalogue.h"
#include "tests/app/striae_program.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

using ::testing::HasSubstr;
using testing::Ran;
using testing::Striae;

/// All commands that do something, as the words that name them.
void Collect(const CLI::App& app, const std::vector<std::string>& path, std::vector<std::vector<std::string>>& leaves) {
  const auto subs = app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
  if (subs.empty() && !path.empty()) leaves.push_back(path);
  for (const CLI::App* sub : subs) {
    auto next = path;
    next.push_back(sub->get_name());
    Collect(*sub, next, leaves);
  }
}

std::vector<std::vector<std::string>> AllCommands() {
  app::Context context;
  CLI::App root;
  app::AddAllCommands(root, context);
  std::vector<std::vector<std::string>> leaves;
  Collect(root, {}, leaves);
  return leaves;
}

TEST(Program, EveryCommandExplainsItselfWithAnExample) {
  const auto commands = AllCommands();
  ASSERT_GE(commands.size(), 20U);
  for (auto words : commands) {
    words.push_back("--help");
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, 0) << words.front();
    EXPECT_THAT(ran.out, ::testing::ContainsRegex("Example:\n  .*striae")) << ran.out;
    EXPECT_THAT(ran.out, HasSubstr("--json")) << ran.out;
  }
}

TEST(Program, WrongUsageIsTwoAndSaysSoOnStderr) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{}, {"nonsense"}, {"reconstruct"}, {"phase", "--no-such-option"}}) {
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, 2);
    EXPECT_EQ(ran.out, "");
    EXPECT_NE(ran.err, "");
  }
}

TEST(Program, VersionNamesItsLibraries) {
  const Ran ran = Striae({"--version"});
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* library : {"striae", "OpenCV", "FFTW", "CGAL", "PCL", "DCMTK", "SQLite", "libgphoto2", "Exiv2",
                              "Eigen", "Embree", "Cairo"}) {
    EXPECT_THAT(ran.out, HasSubstr(library));
  }
}

TEST(Program, CompletionIsValidShellAndKnowsEveryCommand) {
  const Ran ran = Striae({"completion", "bash"});
  ASSERT_EQ(ran.exit_code, 0);
  for (const auto& words : AllCommands()) EXPECT_THAT(ran.out, HasSubstr(words.back()));
  const testing::TempDir folder;
  std::ofstream(folder / "striae.bash") << ran.out
                                        << "\nCOMP_WORDS=(striae measure wo); COMP_CWORD=2; _striae\n"
                                           "echo \"${COMPREPLY[@]}\"\n";
  const Ran shell = testing::RunProgram("bash", {(folder / "striae.bash").string()}, folder.path());
  EXPECT_EQ(shell.exit_code, 0) << shell.err;
  EXPECT_EQ(shell.out, "wound\n");
}

}  // namespace
}  // namespace striae
