// Backup, restore, merge and identities with the program, and a name that stands nowhere else.
#include <algorithm>
#include <csignal>
#include <cstdlib>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/app/import_study.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;

class Copies : public testing::ProgramStudy {
 protected:
  void SetIdentity(const std::string& subject, const std::string& name) const {
    const json person = {{"name", name}, {"birth_date", "1950-01-31"}, {"hospital_id", "H-77-SEEDED"}};
    Do({"identity", "set", subject, "--from", Write("person.json", person.dump()), "--passphrase-file",
        Write("key.txt", "four random words here\n")});
    fs::remove(Path("person.json"));
  }
};

TEST_F(Copies, ABackupRestoresToTheSameHeadAndAnUnfinishedOneIsRefused) {
  Do({"import", "--session", session_, WritePhoto("DSC_0001.JPG")});
  const json backup = Do({"backup", Path("backup")});
  Do({"subject", "add", "S002"});  // written later: not in it
  const json restored = Must({"restore", Path("backup"), Path("again")});
  EXPECT_EQ(restored.at("head"), backup.at("head"));
  EXPECT_EQ(restored.at("objects"), 1);
  const json check = Must({"-C", Path("again"), "check"});
  EXPECT_EQ(check.at("head_text"), backup.at("head"));
  EXPECT_EQ(check.at("findings"), json::array());
  EXPECT_EQ(Run({"backup", Path("backup")}).exit_code, 1) << "nothing is overwritten";
  Write("backup/UNFINISHED", "x");
  EXPECT_EQ(testing::Striae({"restore", Path("backup"), Path("third")}).exit_code, 1);
}

TEST_F(Copies, TwoSitesComeTogetherEitherWay) {
  Must({"restore", study_, Path("laptop"), "--branch"});
  Do({"subject", "add", "S002"});
  Must({"-C", Path("laptop"), "subject", "add", "S002"});
  Must({"-C", Path("laptop"), "import", "--session", session_, WritePhoto("DSC_0009.JPG")});
  const json here = Do({"merge", Path("laptop")});
  EXPECT_EQ(here.at("objects"), 1);
  ASSERT_EQ(here.at("queries").size(), 1U) << "S002 at both";
  Must({"-C", Path("laptop"), "merge", study_});
  EXPECT_EQ(Do({"subject", "list"}), Must({"-C", Path("laptop"), "subject", "list"}));
  EXPECT_EQ(Do({"show", session_}), Must({"-C", Path("laptop"), "show", session_}));
  EXPECT_EQ(Do({"merge", Path("laptop")}).at("rows"), 0);
  EXPECT_EQ(Do({"query", "list"}).dump(), Must({"-C", Path("laptop"), "query", "list"}).dump());
  for (const std::string& copy : {study_, Path("laptop")}) EXPECT_TRUE(Must({"-C", copy, "check"}).at("passed"));
}

TEST_F(Copies, CheckSettlesWhatAKilledProgramLeftAndNamesACutTrail) {
  Do({"check", "--save-head", Path("head.txt")});
  Write("trial/objects/.part-abc", "half a photograph");
  EXPECT_EQ(Do({"check"}).at("findings").at(0).at("severity"), "warning");
  const json repaired = Do({"check", "--repair"});
  EXPECT_EQ(repaired.at("repaired").size(), 1U);
  EXPECT_EQ(repaired.at("findings"), json::array());
  EXPECT_TRUE(Do({"check", "--head", Path("head.txt")}).at("passed"));
  EXPECT_EQ(Run({"check", "--from", study_}).exit_code, 2) << "--from goes with --repair";
}

TEST_F(Copies, IdentitiesOpenWithTheirPassphraseOnlyAndSayNothingToTheTrail) {
  SetIdentity("S001", "Test^Subject");
  const std::string key = Path("key.txt");
  EXPECT_EQ(Do({"identity", "show", "S001", "--passphrase-file", key}).at("identities").at(0).at("name"),
            "Test^Subject");
  const Ran wrong = Run({"identity", "show", "--passphrase-file", Write("wrong.txt", "four wrong words here\n")});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.out, "");
  Do({"identity", "passphrase", "--passphrase-file", key, "--new-passphrase-file",
      Write("new.txt", "another phrase\n")});
  EXPECT_EQ(Run({"identity", "show", "--passphrase-file", key}).exit_code, 1);
  EXPECT_EQ(Do({"identity", "show", "--passphrase-file", Path("new.txt")}).at("identities").size(), 1U);
  const Ran bad = Run({"identity", "set", "S001", "--from", Write("p.json", R"({"name": "Test^Subject", "age": 7})"),
                       "--passphrase-file", Path("new.txt")});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_EQ(bad.err.find("Test^Subject"), std::string::npos) << "an error repeats nothing of the file";
  EXPECT_EQ(Run({"identity", "set", "S404", "--from", Path("p.json"), "--passphrase-file", key}).exit_code, 1);
}

/// Files below `folder` that contain any of the words, as they are or in UTF-16.
std::vector<std::string> FilesWith(const fs::path& folder, const std::vector<std::string>& words) {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string text = testing::ReadText(entry.path());
    for (const std::string& word : words) {
      std::string wide;
      for (const char c : word) wide += std::string(1, c) + '\0';
      if (text.find(word) == std::string::npos && text.find(wide) == std::string::npos) continue;
      found.push_back(entry.path().lexically_relative(folder).string() + ": " + word);
    }
  }
  return found;
}

/// Takes connections and never answers.
class SilentPacs {
 public:
  SilentPacs() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof any;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&any), size), 0);
    EXPECT_EQ(::listen(socket_, 4), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&any), &size), 0);
    port_ = ntohs(any.sin_port);
  }
  ~SilentPacs() { ::close(socket_); }
  SilentPacs(const SilentPacs&) = delete;
  SilentPacs& operator=(const SilentPacs&) = delete;
  [[nodiscard]] int port() const { return port_; }

 private:
  int socket_, port_ = 0;
};

TEST_F(Copies, ASeededNameStandsInNoOtherFile) {
  const std::vector<std::string> seeds = {"Seededname", "H-77-SEEDED", "1950-01-31", "19500131"};
  SetIdentity("S001", "Seededname^Invented");
  const std::string photo = WritePhoto("card/DSC_0001.JPG");
  std::string said;
  const auto run = [&](const std::vector<std::string>& words) {
    const Ran ran = Run(words);
    said += ran.out + ran.err;
    return ran.exit_code;
  };
  EXPECT_EQ(run({"import", "--session", session_, photo, "--sidecar"}), 0);
  EXPECT_EQ(run({"outline", Do({"show", session_}).at("captures").at(0).at("id").get<std::string>(),
                 Write("o.json", R"({"polygon_px": [[100,100],[900,100],[500,900]]})")}),
            0);
  run({"process"});
  EXPECT_EQ(run({"dicom", "export", "--session", session_, "--out", Path("dicom")}), 0) << said;
  // Objects are built when they are sent: what a PACS that is away or a kill in the middle leaves has no name either.
  fs::create_directories(Path("tmp"));
  ::setenv("TMPDIR", Path("tmp").c_str(), 1);
  const SilentPacs pacs;
  const std::vector<std::string> send = {"dicom", "send", "--session", session_, "--host", "127.0.0.1", "--port"};
  auto away = send, stalled = send;
  away.push_back("1");
  EXPECT_EQ(run(away), 1);
  stalled.push_back(std::to_string(pacs.port()));
  stalled.insert(stalled.begin(), {"-s", "KILL", "4", std::string(STRIAE_BINARY_DIR) + "/striae", "-C", study_});
  EXPECT_EQ(testing::RunProgram("timeout", stalled).exit_code, 128 + SIGKILL);
  EXPECT_FALSE(fs::is_empty(Path("tmp"))) << "the kill came while the objects were there";
  ::unsetenv("TMPDIR");
  EXPECT_EQ(run({"identity", "set", "S001", "--from", Write("gone/../person.json", R"({"name": "x"})"),
                 "--passphrase-file", Path("wrong.txt")}),
            1);
  SetIdentity("S001", "Seededname^Again");
  EXPECT_EQ(run({"status"}), 0);
  EXPECT_EQ(run({"history", "S001"}), 0);
  EXPECT_EQ(run({"show", "S001"}), 0);
  EXPECT_EQ(run({"check"}), 0);
  EXPECT_EQ(run({"backup", Path("backup")}), 0);
  run({"report", "S001", "--out", Path("report.html")});
  EXPECT_EQ(FilesWith(dir_.path(), seeds), std::vector<std::string>()) << "not even in the encrypted file's own bytes";
  for (const std::string& seed : seeds) EXPECT_EQ(said.find(seed), std::string::npos) << seed;
  // The test can fail: what is looked for is found where it stands.
  Write("seeded.txt", "Seededname");
  EXPECT_EQ(FilesWith(dir_.path(), seeds).size(), 1U);
}

}  // namespace
}  // namespace striae
