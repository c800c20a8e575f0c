// The study's commands as a coordinator types them: what they print, and what they say to wrong input.
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/app/striae_program.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;
using testing::Striae;

constexpr int kDone = 0, kFailed = 1, kUsage = 2;

const char* const kCalibration = R"({"format": "striae-calibration/1", "image_size": [4288, 2848],
  "camera": {"fx": 9100, "fy": 9100, "cx": 2144, "cy": 1424, "k1": 0, "k2": 0, "p1": 0, "p2": 0},
  "projector": {"model": "pinhole", "center_mm": [0, -150, 0], "rotation_rodrigues": [0.1, 0, 0], "focal_stripes": 1040,
  "center_order": 70, "k1": 0}, "grating": {"stripes": 140, "direction": "horizontal"},
  "working_distance_mm": [800, 1200]})";

class StudyCommands : public ::testing::Test {
 protected:
  StudyCommands() {
    const Ran made = Striae({"init", study_, "--protocol", "WND-01", "--title", "Healing", "--sponsor",
                             "Example Institute", "--site", "LJ", "--json"});
    EXPECT_EQ(made.exit_code, kDone) << made.err;
  }

  /// A command on the study, with --json.
  [[nodiscard]] Ran Run(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    words.emplace_back("--json");
    return Striae(words);
  }
  json Done(const std::vector<std::string>& words) const {
    const Ran ran = Run(words);
    EXPECT_EQ(ran.exit_code, kDone) << words.front() << ": " << ran.err;
    json document = ran.Json();
    EXPECT_FALSE(document.is_discarded()) << ran.out;
    return document;
  }
  /// Exit code and words on stderr; nothing on stdout, and the study as it was.
  void Refused(const std::vector<std::string>& words, int code, const std::string& message) const {
    const Ran ran = Run(words);
    EXPECT_EQ(ran.exit_code, code) << words.front() << ": " << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(message));
    EXPECT_EQ(ran.out, "") << words.front();
  }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(dir_ / name) << text;
    return (dir_ / name).string();
  }

  testing::TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
};

TEST_F(StudyCommands, LeadFromInitToAnOpenSession) {
  EXPECT_EQ(Done({"subject", "add", "S001"}).at("pseudonym"), "S001");
  EXPECT_EQ(Done({"consent", "S001", "--given", "2026-05-04"}).at("consent_active"), true);
  EXPECT_EQ(Done({"subject", "list"}).at("subjects").at(0).at("consent_given"), "2026-05-04");
  EXPECT_EQ(Done({"device", "add", "--serial", "6123456", "--range", "small"}).at("model"), "NIKON D90");
  const std::string cal = Write("cal.json", kCalibration);
  EXPECT_EQ(Done({"calibration", "add", cal, "--device", "6123456", "--valid-from", "2026-05-01"}).at("valid_from"),
            "2026-05-01");
  EXPECT_EQ(Done({"device", "list"}).at("devices").at(0).at("calibrations").size(), 1U);
  const json session = Done({"session", "open", "--subject", "S001", "--visit", "V1"});
  const std::string id = session.at("id");
  EXPECT_EQ(session.at("visit"), "V1");
  EXPECT_EQ(Done({"session", "list"}).at("sessions").at(0).at("id"), id);
  EXPECT_EQ(Done({"show", id}).at("captures"), json::array());
  EXPECT_EQ(Done({"results"}).at("measurements"), json::array());
  EXPECT_EQ(Done({"results", "--subject", "S001", "--session", id}).at("measurements"), json::array());
  EXPECT_EQ(Done({"status"}).at("open_sessions"), 1);
  EXPECT_NE(Done({"session", "close", id}).at("closed_at"), json());
  EXPECT_EQ(Done({"history", "S001"}).at("history").size(), 2U);
  const json check = Done({"check"});
  EXPECT_EQ(check.at("passed"), true);
  EXPECT_EQ(Done({"check", "--head", check.at("head_text")}).at("passed"), true);
}

TEST_F(StudyCommands, PrintTextForAPerson) {
  Done({"subject", "add", "S001"});
  EXPECT_EQ(Striae({"-C", study_, "subject", "list"}).out, "S001  no consent\n");
  EXPECT_THAT(Striae({"-C", study_, "status"}).out, HasSubstr("1 subjects without active consent"));
  EXPECT_THAT(Striae({"-C", study_, "show", "S001"}).out, HasSubstr("pseudonym: S001"));
  EXPECT_THAT(Striae({"-C", study_, "check"}).out, HasSubstr("passed"));
}

TEST_F(StudyCommands, RecordTheUserWhoRunsThem) {
  ::setenv("STRIAE_USER", "night shift", 1);
  Done({"subject", "add", "S001"});
  ::unsetenv("STRIAE_USER");
  EXPECT_EQ(Done({"history", "S001"}).at("history").at(0).at("user"), "night shift");
}

TEST_F(StudyCommands, SayWhatIsWrongWithTheirInput) {
  Done({"subject", "add", "S001"});
  Refused({"subject", "add", "S001"}, kFailed, "already");
  Refused({"subject", "add", "Test Subject"}, kUsage, "never a name");
  Refused({"subject", "add", "S002", "--site", "XX"}, kUsage, "LJ");
  Refused({"consent", "S404", "--given", "2026-05-04"}, kFailed, "subject list");
  Refused({"consent", "S001"}, kUsage, "--given");
  Refused({"consent", "S001", "--given", "4.5.2026"}, kUsage, "2026-05-04");
  Refused({"consent", "S001", "--given", "2026-02-30"}, kUsage, "not a date");
  Refused({"consent", "S001", "--given", "2026-05-04", "--withdrawn", "2026-05-05"}, kUsage, "");
  Refused({"consent", "S001", "--withdrawn", "2026-05-05"}, kFailed, "no consent");
  Refused({"device", "add", "--serial", "1", "--range", "huge"}, kUsage, "small (1 m)");
  Refused({"session", "open", "--subject", "S404", "--visit", "V1"}, kFailed, "S404");
  Refused({"session", "open", "--subject", "S001"}, kUsage, "--visit");
  Refused({"session", "close", "no-session"}, kFailed, "session list");
  Refused({"session", "close", "3f0c4f5e-8a55-4f0e-9d5e-0a6c3c1d2b10"}, kFailed, "session list");
  Refused({"session", "list", "--subject", "S404"}, kFailed, "S404");
  Refused({"results", "--subject", "S404"}, kFailed, "S404");
  Refused({"results", "--session", "x"}, kFailed, "session list");
  Refused({"show", "S404"}, kFailed, "S404");
  Refused({"history", "S404"}, kFailed, "S404");
  Refused({"check", "--head", "nonsense"}, kUsage, "NUMBER:HASH");
  EXPECT_EQ(Done({"check"}).at("audit_rows"), 3) << "study, site and one subject: nothing else was written";
}

TEST_F(StudyCommands, SayWhatIsWrongWithTheirFiles) {
  Done({"device", "add", "--serial", "1", "--range", "small"});
  const std::string good = Write("good.json", kCalibration), bad = Write("bad.json", "{\"format\": \"something\"}");
  Refused({"calibration", "add", (dir_ / "absent.json").string(), "--device", "1", "--valid-from", "2026-05-01"},
          kFailed, "does not exist");
  Refused({"calibration", "add", bad, "--device", "1", "--valid-from", "2026-05-01"}, kFailed, "bad.json");
  Refused({"calibration", "add", good, "--device", "2", "--valid-from", "2026-05-01"}, kFailed, "device add");
  Refused({"calibration", "add", good, "--device", "1", "--valid-from", "soon"}, kUsage, "--valid-from");
  const std::string outline = Write("o.json", R"({"polygon_px": [[1,1],[9,1],[5,9]]})");
  Refused({"outline", "3f0c4f5e", outline}, kFailed, "3f0c4f5e");
  Refused({"outline", "3f0c4f5e", bad}, kFailed, "bad.json");
  Refused({"outline", "3f0c4f5e", (dir_ / "absent.json").string()}, kFailed, "does not exist");
}

TEST_F(StudyCommands, NeedAStudyAndMakeOneOnlyOnce) {
  const std::string elsewhere = (dir_ / "elsewhere").string();
  const std::vector<std::vector<std::string>> commands = {{"status"}, {"check"}, {"results"}, {"show", "S001"}};
  for (const std::vector<std::string>& words : commands) {
    std::vector<std::string> all = {"-C", elsewhere};
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = Striae(all);
    EXPECT_EQ(ran.exit_code, kFailed);
    EXPECT_THAT(ran.err, HasSubstr("striae init"));
  }
  EXPECT_FALSE(std::filesystem::exists(elsewhere));
  const Ran again = Striae({"init", study_, "--protocol", "X", "--title", "X", "--sponsor", "X", "--site", "X"});
  EXPECT_EQ(again.exit_code, kFailed);
  EXPECT_THAT(again.err, HasSubstr("a study already"));
  EXPECT_EQ(Striae({"init", elsewhere, "--protocol", "X"}).exit_code, kUsage);
  EXPECT_FALSE(std::filesystem::exists(elsewhere));
}

TEST_F(StudyCommands, ADamagedStudyFailsItsCheckAndSaysWhere) {
  std::ofstream(dir_ / "trial/objects/left-behind") << "x";
  EXPECT_EQ(Done({"check"}).at("findings").at(0).at("severity"), "warning");
  const Ran cut = Run({"check", "--head", "9999:" + std::string(64, 'a')});
  EXPECT_EQ(cut.exit_code, kFailed);
  EXPECT_EQ(cut.Json().at("passed"), false) << "the findings are printed all the same";
  EXPECT_THAT(cut.out, HasSubstr("cut at its end"));
}

}  // namespace
}  // namespace striae
