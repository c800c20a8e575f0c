// A printed label in a photograph that was logged in another subject's session, through the program.
#include <gmock/gmock.h>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Ran;
using testing::Striae;

/// Two subjects with a session each; the label of the first one's session lies on the ball that is photographed.
class LabelledSession : public ::testing::Test {
 protected:
  void SetUp() override {
    Must({"init", study_, "--protocol", "LAB-1", "--title", "Labels", "--sponsor", "Example Institute", "--site", "A"});
    for (const char* subject : {"S001", "S002"}) {
      In({"subject", "add", subject});
      In({"consent", subject, "--given", "2026-05-01"});
    }
    first_ = In({"session", "open", "--subject", "S001", "--visit", "V1"}).at("id");
    second_ = In({"session", "open", "--subject", "S002", "--visit", "V1"}).at("id");
    const json label = In({"print", "label", "--session", first_, "--out", At("label.pdf")}).at("labels").at(0);
    code_ = label.at("code");
    Photograph(label.at("marker").get<int>());
  }
  /// Half the D90's pixels a side: the label's cells still have nine of them.
  void Photograph(int marker) {
    Must({"simulate", "ball", "--scale", "0.5", "--out", At("ball"), "--label", std::to_string(marker) + ",30,0,0"});
    In({"device", "add", "--serial", "3990001", "--range", "small"});
    In({"calibration", "add", At("ball/calibration.json"), "--device", "3990001", "--valid-from", "2026-01-01"});
  }
  std::string Import(const std::string& session) {
    const json taken = In({"import", "--session", session, At("ball/ball.jpg"), "--as", "wound:W1"});
    const std::string capture = taken.at("files").at(0).at("capture");
    const json square = json::array({{980, 800}, {1080, 800}, {1080, 860}, {980, 860}});
    Write("outline.json", json{{"polygon_px", square}}.dump());
    In({"outline", capture, At("outline.json")});
    return capture;
  }
  Ran Process() { return Striae({"-C", study_, "process", "--json"}); }
  /// Reasons that numbers are flagged with, in one text.
  std::string Reasons() {
    std::string text;
    const json results = In({"results"});
    EXPECT_FALSE(results.at("measurements").empty());
    for (const json& row : results.at("measurements")) text += row.value("reason", "") + "\n";
    return text;
  }
  static json Must(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, 0) << words.front() << ": " << ran.err;
    return ran.Json();
  }
  json In(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    return Must(std::move(words));
  }
  void Write(const std::string& name, const std::string& text) const {
    testing::WriteBytes(dir_ / name, {text.begin(), text.end()});
  }
  [[nodiscard]] std::string At(const std::string& name) const { return (dir_ / name).string(); }

  testing::TempDir dir_;
  std::string study_ = At("trial"), first_, second_, code_;
};

TEST_F(LabelledSession, OfAnotherSubjectIsNamedNotedAndFlagged) {
  const std::string capture = Import(second_);
  const Ran ran = Process();
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto whose = AllOf(HasSubstr(code_ + " (S001, V1)"), HasSubstr("(S002, V1)"), HasSubstr("reassign"));
  EXPECT_THAT(ran.err, AllOf(HasSubstr("WRONG LABEL"), whose));
  EXPECT_THAT(ran.Json().at("processed").at(0).at("warning").get<std::string>(), whose);
  EXPECT_THAT(Reasons(), whose) << "no number leaves the study without it";
  const json notes = In({"note", "list"}).at("notes");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes.at(0).at("kind"), "deviation");
  EXPECT_THAT(notes.at(0).at("text").get<std::string>(), whose);

  // Said again, noted once, computed once.
  const Ran again = Process();
  EXPECT_THAT(again.err, HasSubstr("WRONG LABEL"));
  EXPECT_EQ(again.Json().at("processed").at(0).at("state"), "up-to-date");
  EXPECT_EQ(In({"note", "list"}).at("notes").size(), 1U);

  // Moved to where the label says: nothing is in doubt any more; what was noted stays.
  Write("key.txt", "four random words here\n");
  In({"user", "add", "anna", "--role", "investigator"});
  In({"user", "passphrase", "anna", "--new-passphrase-file", At("key.txt")});
  In({"reassign", capture, "--to", first_, "--reason", "the label says so", "--user", "anna", "--passphrase-file",
      At("key.txt")});
  const Ran moved = Process();
  EXPECT_EQ(moved.exit_code, 0) << moved.err;
  EXPECT_THAT(moved.err, Not(HasSubstr("WRONG LABEL")));
  EXPECT_THAT(Reasons(), Not(HasSubstr("the label in the photograph")));
  EXPECT_EQ(In({"note", "list"}).at("notes").size(), 1U);
  EXPECT_TRUE(In({"check"}).at("passed"));
}

TEST_F(LabelledSession, OfItsOwnIsNotWorthAWord) {
  Import(first_);
  const Ran ran = Process();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.err, Not(HasSubstr("WRONG LABEL")));
  EXPECT_THAT(Reasons(), Not(HasSubstr("the label in the photograph")));
  EXPECT_TRUE(In({"note", "list"}).at("notes").empty());
}

}  // namespace
}  // namespace striae
