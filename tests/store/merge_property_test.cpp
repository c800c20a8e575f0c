// Whatever was done at two sites: what comes together does not depend on who takes in whom.
#include <rapidcheck.h>

#include "tests/store/sites.h"

namespace striae::testing {
namespace {

/// One thing that a person does at one copy; few names, so that both copies collide often.
void Act(store::Record& record, const Sites& sites, int what) {
  const std::string few = std::to_string(what / 8 % 3);
  switch (what % 8) {
    case 0:
    case 1:
      (void)record.AddSubject({CountedId<SubjectId>(), "S10" + few, record.Sites()->front().id, {}, {}}, NextStamp());
      break;
    case 2:
    case 3:
      (void)record.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("photo " + few), NextStamp());
      break;
    case 4:
      (void)record.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W" + few), "seen again", NextStamp());
      break;
    case 5:
      (void)record.AddReport(CountedId<ReportId>(), sites.capture_.id, WoundReport(sites.capture_, 1.0 + what),
                             NextStamp());
      break;
    case 6: {
      Session session = sites.session_;
      session.id = CountedId<SessionId>();
      (void)record.OpenSession(session, "V" + few, CountedId<VisitId>(), NextStamp());
      break;
    }
    default:
      (void)record.WithdrawConsent(sites.subject_.id, {2026, 5, 20}, "asked to stop", NextStamp());
      (void)record.GiveConsent(sites.subject_.id, {2026, 5, 21}, NextStamp());
  }
}

TEST(Merge, IsTheSameBothWaysAndTwiceIsOnceWhateverWasDone) {
  // Each case copies whole studies, so there are few of them, from rapidcheck's generator with fixed seeds.
  constexpr int kCases = 5, kSize = 14;
  const auto actions = rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 256));
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
    const std::vector<int> at_a = actions(rc::Random(2 * seed), kSize).value();
    const std::vector<int> at_b = actions(rc::Random(2 * seed + 1), kSize).value();
    Sites sites;
    {
      auto a = sites.Open("a"), b = sites.Open("b");
      for (const int what : at_a) Act(a, sites, what);
      for (const int what : at_b) Act(b, sites, what);
    }
    ASSERT_EQ(sites.BothWays(), "") << "seed " << seed;
    const auto once = ContentOf(sites.At("a"));
    sites.Merge("a", "b");
    ASSERT_EQ(ContentOf(sites.At("a")), once) << "seed " << seed;
    sites.Merge("b", "a");
    ASSERT_EQ(Compare(sites.At("a"), sites.At("b")), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace striae::testing
