// When a session was, as a coordinator types it: days and hours at the site, windows of the plan, what lies ahead.
#include "tests/app/import_study.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;

class SessionDate : public testing::ProgramStudy {
 protected:
  void SetUp() override {
    Must({"init", study_, "--protocol", "DAY-1", "--title", "Days", "--sponsor", "Example Institute", "--site", "LJ",
          "--time-zone", "Europe/Ljubljana"});
    Do({"subject", "add", "S001"});
    Do({"consent", "S001", "--given", "2026-05-01"});
  }
  json Open(const std::string& visit, const std::string& date) const {
    return Do({"session", "open", "--subject", "S001", "--visit", visit, "--date", date});
  }
};

TEST_F(SessionDate, IsReadInTheSitesZoneInSummerAndWinter) {
  EXPECT_EQ(Open("V1", "2026-05-04").at("opened_at"), "2026-05-04T10:00:00.000Z") << "noon, two hours before UTC";
  EXPECT_EQ(Open("V2", "2026-01-04T00:30").at("opened_at"), "2026-01-03T23:30:00.000Z") << "one hour in winter";
  EXPECT_EQ(Open("V3", "2026-01-04T00:30").at("day"), "2026-01-04") << "the day at the site, not in Greenwich";
}

TEST_F(SessionDate, ThatIsNoneOrLiesAheadIsRefused) {
  for (const char* date : {"4.5.2026", "2026-02-30", "2026-05-04T25:00", "2026-05-04T10:30x", "2099-01-01"}) {
    const Ran ran = Run({"session", "open", "--subject", "S001", "--visit", "V1", "--date", date});
    EXPECT_EQ(ran.exit_code, 2) << date;
    EXPECT_THAT(ran.err, HasSubstr("--date"));
  }
  EXPECT_EQ(Do({"session", "list"}).at("sessions"), json::array());
}

TEST_F(SessionDate, OutOfItsWindowIsNotedAsADeviation) {
  Do({"visit", "plan", "add", "V1", "--day", "0"});
  Do({"visit", "plan", "add", "V2", "--day", "14", "--window", "-3,+3"});
  for (const char* window : {"3", "+3,-3", "a,b", "-3,", ""}) {
    const Ran ran = Run({"visit", "plan", "add", "V3", "--day", "28", "--window", window});
    EXPECT_EQ(ran.exit_code, *window == '\0' ? 0 : 2) << window;
  }
  Open("V1", "2026-05-04");
  Open("V2", "2026-05-21");
  EXPECT_EQ(Do({"note", "list"}).at("notes"), json::array()) << "the last day of the window";
  const json late = Open("V2", "2026-05-22");
  const json notes = Do({"note", "list"}).at("notes");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0].dump(), HasSubstr(late.at("id").get<std::string>()));
  EXPECT_THAT(notes[0].at("text").get<std::string>(), HasSubstr("2026-05-15 to 2026-05-21"));
}

}  // namespace
}  // namespace striae
