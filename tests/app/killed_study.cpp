#include "tests/app/killed_study.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/test_data.h"

namespace striae::testing {
namespace {

using nlohmann::json;
using Command = KilledStudy::Command;
constexpr const char* kTruth = "practice/wound_0/truth.json";
constexpr const char* kWound = "practice/wound_0/visit_0.jpg";

// A rig of the default kind; the practice photograph, where it is there, is measured with its own.
constexpr const char* kCalibration = R"({"format": "striae-calibration/1", "image_size": [4288, 2848],
  "camera": {"fx": 9100, "fy": 9100, "cx": 2144, "cy": 1424, "k1": 0, "k2": 0, "p1": 0, "p2": 0},
  "projector": {"model": "pinhole", "center_mm": [0, -150, 0], "rotation_rodrigues": [0.1, 0, 0], "focal_stripes": 1040,
  "center_order": 70, "k1": 0}, "grating": {"stripes": 140, "direction": "horizontal"},
  "working_distance_mm": [800, 1200]})";

}  // namespace

KilledStudy::KilledStudy() {
  Must({"init", study_, "--protocol", "KILL-1", "--title", "Killed", "--sponsor", "Example Institute", "--site", "A"});
  Write("key.txt", "four random words here\n");
  Write("person.json", R"({"name": "Test^Subject", "birth_date": "1950-01-31"})");
  for (const char* subject : {"S001", "S002"}) {
    Do({"subject", "add", subject});
    Do({"consent", subject, "--given", "2026-05-01"});
  }
  session_ = Open("S001", "V1");
  other_session_ = Open("S002", "V1");
  Do({"user", "add", "anna", "--role", "investigator", "--full-name", "Test Investigator"});
  Do({"user", "passphrase", "anna", "--new-passphrase-file", Path("key.txt")});
  moved_ = Do({"import", "--session", session_, Photo("moved.jpg")}).at("files").at(0).at("capture");
  const std::string photo = HasTestData(kWound) ? TestData(kWound).string() : Photo("wound.jpg");
  wound_ = Do({"import", "--session", session_, photo, "--as", "wound:W1"}).at("files").at(0).at("capture");
  if (HasTestData(kWound)) {
    Do({"device", "add", "--serial", "6123456", "--range", "small"});
    Do({"calibration", "add", TestData("practice/true_small.json").string(), "--device", "6123456", "--valid-from",
        "2026-05-01"});
  }
  Do({"arm", "add", "A"});
  Do(SetIdentity("").words);
  Must({"restore", study_, Path("laptop"), "--branch"});
}

const std::vector<KilledStudy::Make>& KilledStudy::All() {
  using K = KilledStudy;
  // Import three times: photographs matter most.
  static const std::vector<Make> all = {
      &K::Import,        &K::AddSubject,     &K::Consent,     &K::OpenSession,
      &K::Process,       &K::Outline,        &K::Reassign,    &K::Merge,
      &K::Backup,        &K::Sign,           &K::Import,      &K::ImportWithSidecar,
      &K::ImportBroken,  &K::Watch,          &K::Init,        &K::Withdraw,
      &K::AddArm,        &K::AssignArm,      &K::PlanVisit,   &K::ReplanVisit,
      &K::AddDevice,     &K::AddCalibration, &K::Import,      &K::CloseSession,
      &K::ReopenSession, &K::Exclude,        &K::Note,        &K::StrikeTreatment,
      &K::OpenQuery,     &K::AnswerQuery,    &K::AddUser,     &K::SetPassphrase,
      &K::ChangeUser,    &K::Lock,           &K::Unlock,      &K::Restore,
      &K::Repair,        &K::SetIdentity,    &K::AddSite,     &K::CorrectTreatment,
      &K::CorrectNote,   &K::CloseQuery,     &K::ReopenQuery, &K::ChangeIdentityPassphrase};
  return all;
}
std::size_t KilledStudy::Kinds() { return All().size(); }
Command KilledStudy::Prepare(std::size_t kind, const std::string& round) { return (this->*All()[kind])(round); }

json KilledStudy::Must(Words words) {
  words.emplace_back("--json");
  const Ran ran = Striae(words);
  EXPECT_EQ(ran.exit_code, 0) << ::testing::PrintToString(words) << ": " << ran.err;
  return ran.Json();
}
json KilledStudy::Do(Words words) const {
  words.insert(words.begin(), {"-C", study_});
  return Must(std::move(words));
}
Ran KilledStudy::Run(const Command& command) const {
  Words words = command.words;
  if (command.on_study) words.insert(words.begin(), {"-C", study_});
  words.emplace_back("--json");
  return Striae(words);
}
std::function<void()> KilledStudy::Shows(Words words, const std::string& text) const {
  return [this, words = std::move(words), text] { EXPECT_THAT(Do(words).dump(), ::testing::HasSubstr(text)); };
}
KilledStudy::Words KilledStudy::SignedIn(Words words) const {
  words.insert(words.end(), {"--user", "anna", "--passphrase-file", Path("key.txt")});
  return words;
}
std::string KilledStudy::Write(const std::string& name, const std::string& text) const {
  WriteBytes(dir_ / name, {text.begin(), text.end()});
  return Path(name);
}
/// A whole photograph that is another one for every name.
std::string KilledStudy::Photo(const std::string& name) const {
  PhotoOptions options;
  options.lens = name;
  WriteBytes(dir_ / name, MakeJpeg(options));
  return Path(name);
}
std::string KilledStudy::Open(const std::string& subject, const std::string& visit) const {
  return Do({"session", "open", "--subject", subject, "--visit", visit, "--unscheduled", "of the test"}).at("id");
}
/// The practice wound's own outline (else a triangle), with one point a hundredth of a pixel elsewhere every time.
std::string KilledStudy::WriteOutline(const std::string& round) {
  json polygon = json::array({{1800, 1200}, {2400, 1300}, {2100, 1600}});
  if (HasTestData(kTruth)) polygon = json::parse(ReadText(TestData(kTruth))).at(0).at("outline_px");
  polygon[0][0] = polygon[0][0].get<double>() + 0.01 * ++outlines_;
  return Write("outline" + round + ".json", json{{"polygon_px", polygon}}.dump());
}

Command KilledStudy::Import(const std::string& round) {
  // Three: those before the kill were acknowledged one by one.
  return {{"import", "--session", session_, Photo(round + "a.jpg"), Photo(round + "b.jpg"), Photo(round + "c.jpg")},
          {}};
}
Command KilledStudy::ImportWithSidecar(const std::string& round) {
  return {{"import", "--session", session_, Photo("s" + round + ".jpg"), "--as", "wound:W2", "--sidecar"}, {}};
}
Command KilledStudy::ImportBroken(const std::string& round) {
  auto bytes = ReadBytes(Photo("broken" + round + ".jpg"));
  bytes.resize(bytes.size() - 40);
  WriteBytes(dir_ / ("broken" + round + ".jpg"), bytes);
  return {{"import", "--session", session_, Path("broken" + round + ".jpg")},
          Shows({"status"}, "broken" + round + ".jpg")};
}
Command KilledStudy::Watch(const std::string& round) {
  std::filesystem::create_directories(dir_ / ("hot" + round));
  Photo("hot" + round + "/a.jpg");
  return {{"watch", "--session", session_, Path("hot" + round), "--count", "1"}, {}};
}
Command KilledStudy::Init(const std::string& round) {
  const std::string made = Path("made" + round);
  return {{"init", made, "--protocol", "P", "--title", "T", "--sponsor", "S", "--site", "A"},
          [made] {
            Must({"-C", made, "check"});
          },
          false};
}
Command KilledStudy::AddSubject(const std::string& round) {
  return {{"subject", "add", "R" + round, "--site", "A"}, Shows({"show", "R" + round}, "R" + round)};
}
Command KilledStudy::Consent(const std::string& round) {
  Do({"subject", "add", "C" + round, "--site", "A"});
  return {{"consent", "C" + round, "--given", "2026-05-02"}, Shows({"show", "C" + round}, "2026-05-02")};
}
Command KilledStudy::Withdraw(const std::string& round) {
  Do({"subject", "add", "W" + round, "--site", "A"});
  Do({"consent", "W" + round, "--given", "2026-05-02"});
  return {SignedIn({"consent", "W" + round, "--withdrawn", "2026-06-03", "--reason", "moved away"}),
          Shows({"show", "W" + round}, "2026-06-03")};
}
Command KilledStudy::AddArm(const std::string& round) {
  return {{"arm", "add", "arm" + round}, Shows({"arm", "list"}, "arm" + round)};
}
Command KilledStudy::AssignArm(const std::string& round) {
  Do({"subject", "add", "A" + round, "--site", "A"});
  return {{"arm", "assign", "A" + round, "A"}, {}};
}
Command KilledStudy::PlanVisit(const std::string& round) {
  return {{"visit", "plan", "add", "P" + round, "--day", "7", "--window", "-3,+3"},
          Shows({"visit", "plan", "list"}, "P" + round)};
}
Command KilledStudy::ReplanVisit(const std::string& round) {
  Do({"visit", "plan", "add", "Q" + round, "--day", "7"});
  return {{"visit", "plan", "change", "Q" + round, "--day", "8", "--reason", "amendment"}, {}};
}
Command KilledStudy::AddDevice(const std::string& round) {
  return {{"device", "add", "--serial", "7" + round, "--range", "large"}, Shows({"device", "list"}, "7" + round)};
}
Command KilledStudy::AddCalibration(const std::string& round) {
  Do({"device", "add", "--serial", "8" + round, "--range", "large"});
  // Spaces at the end make it another file.
  const std::string file = Write("cal" + round + ".json", kCalibration + std::string(round.size() + 1, ' ') + "\n");
  return {{"calibration", "add", file, "--device", "8" + round, "--valid-from", "2026-05-01"},
          Shows({"device", "list"}, "8" + round)};
}
Command KilledStudy::OpenSession(const std::string& round) {
  return {{"session", "open", "--subject", "S001", "--visit", "V" + round, "--unscheduled", "pain"},
          Shows({"session", "list"}, "\"V" + round + "\"")};
}
Command KilledStudy::CloseSession(const std::string& round) {
  return {{"session", "close", Open("S001", "X" + round)}, {}};
}
Command KilledStudy::ReopenSession(const std::string& round) {
  const std::string id = Open("S001", "Y" + round);
  Do({"session", "close", id});
  return {{"session", "reopen", id, "--reason", "one was forgotten"}, {}};
}
Command KilledStudy::Outline(const std::string& round) { return {{"outline", wound_, WriteOutline(round)}, {}}; }
Command KilledStudy::Process(const std::string& round) {
  Do({"outline", wound_, WriteOutline(round)});
  return {{"process", "--session", session_}, {}};
}
Command KilledStudy::Exclude(const std::string& round) {
  const json taken = Do({"import", "--session", session_, Photo("e" + round + ".jpg")});
  return {{"exclude", taken.at("files").at(0).at("capture"), "--reason", "blurred"}, {}};
}
Command KilledStudy::Note(const std::string& round) {
  return {{"note", "add", "S001", "--text", "note " + round}, Shows({"note", "list"}, "note " + round)};
}
Command KilledStudy::StrikeTreatment(const std::string& round) {
  const json entered = Do({"treatment", "add", "S001", "--date", "2026-05-04", "--text", "t" + round});
  return {{"treatment", "strike", entered.at("id"), "--reason", "another subject's"}, {}};
}
Command KilledStudy::OpenQuery(const std::string& round) {
  return {{"query", "open", "S001", "--text", "question " + round}, Shows({"query", "list"}, "question " + round)};
}
Command KilledStudy::AnswerQuery(const std::string& round) {
  const json asked = Do({"query", "open", "S001", "--text", "asked " + round});
  return {{"query", "answer", asked.at("id"), "--text", "answer " + round},
          Shows({"query", "list"}, "answer " + round)};
}
Command KilledStudy::AddUser(const std::string& round) {
  return {{"user", "add", "user" + round, "--role", "monitor"}, Shows({"user", "list"}, "user" + round)};
}
Command KilledStudy::SetPassphrase(const std::string& round) {
  Do({"user", "add", "p" + round, "--role", "monitor"});
  return {{"user", "passphrase", "p" + round, "--new-passphrase-file", Path("key.txt")}, {}};
}
Command KilledStudy::ChangeUser(const std::string& round) {
  Do({"user", "add", "c" + round, "--role", "monitor"});
  return {{"user", "change", "c" + round, "--role", "clinician", "--reason", "new function"}, {}};
}
Command KilledStudy::Sign(const std::string&) {
  return {SignedIn({"sign", "S002", "--meaning", "reviewed"}), Shows({"signatures"}, "Test Investigator")};
}
Command KilledStudy::Lock(const std::string& round) {
  Do({"subject", "add", "K" + round, "--site", "A"});
  return {SignedIn({"lock", "K" + round, "--reason", "clean " + round}), Shows({"lock", "list"}, "clean " + round)};
}
Command KilledStudy::Unlock(const std::string& round) {
  Do({"subject", "add", "U" + round, "--site", "A"});
  Do(SignedIn({"lock", "U" + round, "--reason", "data are clean"}));
  return {SignedIn({"unlock", "U" + round, "--reason", "wrong date"}), {}};
}
Command KilledStudy::Reassign(const std::string&) {
  const bool there = Do({"show", moved_}).at("session") == other_session_;
  return {SignedIn({"reassign", moved_, "--to", there ? session_ : other_session_, "--reason", "logged wrongly"}), {}};
}
Command KilledStudy::Merge(const std::string& round) {
  Must({"-C", Path("laptop"), "subject", "add", "L" + round, "--site", "A"});
  return {{"merge", Path("laptop")}, Shows({"show", "L" + round}, "L" + round)};
}
Command KilledStudy::Backup(const std::string& round) {
  const std::string to = Path("backup" + round);
  return {{"backup", to}, [to] { Must({"-C", to, "check"}); }};
}
Command KilledStudy::Restore(const std::string& round) {
  const std::string from = Path("kept" + round), to = Path("again" + round);
  Do({"backup", from});
  return {{"restore", from, to}, [to] { Must({"-C", to, "check"}); }, false};
}
Command KilledStudy::Repair(const std::string& round) {
  Write("trial/objects/.part-" + round, "left by a program that was stopped " + round);
  return {{"check", "--repair"}, {}};
}
Command KilledStudy::AddSite(const std::string& round) {
  return {{"site", "add", "S" + round, "--time-zone", "UTC"}, Shows({"site", "list"}, "\"S" + round + "\"")};
}
Command KilledStudy::CorrectTreatment(const std::string& round) {
  const json entered = Do({"treatment", "add", "S001", "--date", "2026-05-04", "--text", "first " + round});
  return {{"treatment", "correct", entered.at("id"), "--text", "corrected " + round, "--reason", "misread"},
          Shows({"treatment", "list"}, "corrected " + round)};
}
Command KilledStudy::CorrectNote(const std::string& round) {
  const json entered = Do({"note", "add", "S001", "--text", "first " + round});
  return {{"note", "correct", entered.at("id"), "--text", "noted " + round, "--reason", "misread"},
          Shows({"note", "list"}, "noted " + round)};
}
Command KilledStudy::CloseQuery(const std::string& round) {
  const json asked = Do({"query", "open", "S001", "--text", "to close " + round});
  return {{"query", "close", asked.at("id"), "--text", "closed " + round}, {}};
}
Command KilledStudy::ReopenQuery(const std::string& round) {
  const json asked = Do({"query", "open", "S001", "--text", "again " + round});
  Do({"query", "close", asked.at("id"), "--text", "too early"});
  return {{"query", "reopen", asked.at("id"), "--text", "not yet"}, Shows({"query", "list"}, "again " + round)};
}
Command KilledStudy::ChangeIdentityPassphrase(const std::string&) {
  // The same one again: whether the kill came before or after, the file opens with it.
  return {{"identity", "passphrase", "--passphrase-file", Path("key.txt"), "--new-passphrase-file", Path("key.txt")},
          {}};
}
Command KilledStudy::SetIdentity(const std::string&) {
  return {{"identity", "set", "S001", "--from", Path("person.json"), "--passphrase-file", Path("key.txt")}, {}};
}

}  // namespace striae::testing
