// `striae watch`: what arrives in a folder goes in once it is complete, however it is written there.
#include <chrono>
#include <csignal>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/app/import_study.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using namespace std::chrono_literals;

class Watch : public testing::ProgramStudy {
 protected:
  void SetUp() override {
    ProgramStudy::SetUp();
    fs::create_directories(dir_ / "in");
  }
  /// Runs the program on in/ while `meanwhile` puts things there.
  template <typename Meanwhile>
  Ran While(std::vector<std::string> more, Meanwhile meanwhile) {
    more.insert(more.begin(), {"watch", "--session", session_, Path("in")});
    std::thread other([&] {
      std::this_thread::sleep_for(200ms);
      meanwhile();
    });
    Ran ran = Run(more);
    other.join();
    return ran;
  }
};

// The end after so many seconds is for a loaded machine; --count ends each test much sooner.
TEST_F(Watch, TakesWhatLiesThereAndWhatIsMovedLinkedOrMadeInNewFolders) {
  WritePhoto("in/DSC_0001.JPG");
  WritePhoto("DSC_0002.JPG");
  WritePhoto("DSC_0003.JPG");
  const Ran ran = While({"--count", "4", "--for", "60"}, [&] {
    fs::rename(Path("DSC_0002.JPG"), Path("in/DSC_0002.JPG"));
    fs::create_hard_link(Path("DSC_0003.JPG"), Path("in/DSC_0003.JPG"));
    WritePhoto("in/101NCD90/DSC_0004.JPG");
  });
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("added"), 4) << ran.err;
}

TEST_F(Watch, WaitsForAFileThatIsWrittenInTwoSteps) {
  const auto bytes = Photo("slow");
  const auto half = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2);
  const Ran ran = While({"--count", "1", "--for", "60"}, [&] {
    testing::WriteBytes(dir_ / "in/DSC_0001.JPG", {bytes.begin(), half});  // closed half-way, as some programs do
    std::this_thread::sleep_for(900ms);
    std::ofstream rest(Path("in/DSC_0001.JPG"), std::ios::app | std::ios::binary);
    rest.write(reinterpret_cast<const char*>(&*half), bytes.end() - half);
  });
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("added"), 1);
  EXPECT_EQ(ran.Json().at("failed"), 0) << "the half was never taken for a broken photograph";
}

TEST_F(Watch, IgnoresUnfinishedNamesAndATouch) {
  const Ran ran = While({"--count", "2", "--for", "60"}, [&] {
    WritePhoto("in/.hidden.JPG");
    WritePhoto("in/DSC_0001.JPG.part");
    WritePhoto("in/DSC_0001.JPG");
    std::this_thread::sleep_for(1200ms);
    fs::last_write_time(Path("in/DSC_0001.JPG"), fs::file_time_type::clock::now());
    std::this_thread::sleep_for(900ms);
    WritePhoto("in/DSC_0002.JPG");
  });
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("added"), 2);
  EXPECT_EQ(Do({"show", session_}).at("captures").size(), 2U);
}

TEST_F(Watch, WithoutTheKernelsWordItLooksAgain) {
  const Ran ran = While({"--count", "1", "--for", "60", "--poll"}, [&] { WritePhoto("in/DSC_0001.JPG"); });
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("added"), 1);
}

TEST_F(Watch, EndsAfterItsTimeAndSaysWhatItDid) {
  const Ran ran = While({"--for", "1"}, [] {});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("added"), 0);
}

TEST_F(Watch, SaysSoWhenTheCardIsPulledOut) {
  WritePhoto("in/DSC_0001.JPG");
  const Ran ran = While({"--for", "60"}, [&] {
    // Once the photograph is in, the folder is being watched for sure.
    for (int i = 0; i < 200 && Do({"show", session_}).at("captures").empty(); ++i) std::this_thread::sleep_for(100ms);
    fs::remove_all(Path("in"));
  });
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, ::testing::HasSubstr("cannot list"));
}

TEST_F(Watch, CtrlCEndsItAndWhatCameInIsThere) {
  WritePhoto("in/DSC_0001.JPG");
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string program = (fs::path(STRIAE_BINARY_DIR) / "striae").string(), folder = Path("in");
    std::freopen(Path("out").c_str(), "w", stdout);
    std::freopen(Path("err").c_str(), "w", stderr);
    ::execl(program.c_str(), "striae", "-C", study_.c_str(), "watch", "--session", session_.c_str(), folder.c_str(),
            "--json", nullptr);
    ::_exit(127);
  }
  for (int i = 0; i < 600 && testing::ReadText(Path("err")).find(": added") == std::string::npos; ++i) {
    std::this_thread::sleep_for(50ms);
  }
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(json::parse(testing::ReadText(Path("out")), nullptr, false).at("added"), 1);
  EXPECT_TRUE(Do({"check"}).at("passed"));
}

}  // namespace
}  // namespace striae
