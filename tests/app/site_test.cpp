// A study with two sites, as a coordinator types it.
#include "tests/app/import_study.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;

class TwoSites : public testing::ProgramStudy {};

TEST_F(TwoSites, EachHasItsSubjectsAndItsClock) {
  const json added = Do({"site", "add", "AK", "--name", "Example Hospital", "--time-zone", "Pacific/Auckland"});
  EXPECT_EQ(added.at("code"), "AK");
  EXPECT_EQ(Do({"site", "list"}).at("sites").size(), 2U);
  const Ran which = Run({"subject", "add", "S900"});
  EXPECT_EQ(which.exit_code, 2) << "with two sites it must be said which";
  EXPECT_THAT(which.err, HasSubstr("--site is one of: A AK"));
  EXPECT_EQ(Do({"subject", "add", "S901", "--site", "AK"}).at("site"), added.at("id"));
  const json session = Do({"session", "open", "--subject", "S901", "--visit", "V1", "--date", "2026-05-04T00:30"});
  EXPECT_EQ(session.at("site_time_zone"), "Pacific/Auckland");
  EXPECT_EQ(session.at("day"), "2026-05-04");
  EXPECT_EQ(session.at("opened_at"), "2026-05-03T12:30:00.000Z") << "twelve hours ahead of UTC in May";
}

TEST_F(TwoSites, AZoneThatIsNoneIsRefusedBeforeAnythingIsWritten) {
  const Ran site = Run({"site", "add", "LJ", "--time-zone", "Europe/Lubljana"});
  EXPECT_EQ(site.exit_code, 2);
  EXPECT_THAT(site.err, HasSubstr("no time zone 'Europe/Lubljana'"));
  EXPECT_EQ(Do({"site", "list"}).at("sites").size(), 1U);
  const Ran study = testing::Striae({"init", Path("other"), "--protocol", "P", "--title", "T", "--sponsor", "S",
                                     "--site", "LJ", "--time-zone", "Europe/Lubljana"});
  EXPECT_EQ(study.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(Path("other")));
  EXPECT_EQ(Run({"site", "add", "a", "--time-zone", "UTC"}).exit_code, 1) << "there is a site A";
}

}  // namespace
}  // namespace striae
