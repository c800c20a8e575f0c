// Whatever is done to a study, in whatever order: the trail is whole, and it alone gives the study again.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "store/annotations.h"
#include "store/as_of.h"
#include "store/locks.h"
#include "store/reassign.h"
#include "tests/store/signed_in.h"

namespace striae::testing {
namespace {

/// A study, two users, and one step of work at a time. What a step is refused is none of this test's business.
class Work {
 public:
  void Step(int kind, int choice) {
    const auto at = [&](const auto& list) { return list[static_cast<std::size_t>(choice) % list.size()]; };
    const Record::Found capture{"capture", captures_.empty() ? "" : at(captures_).id.ToString()};
    if (kind == 0) Enrol();
    if (kind == 1) sessions_.push_back(study_.Open(at(subjects_), "V" + std::to_string(choice % 3)));
    if (kind == 2) Import(at(sessions_), choice % 5);
    if (kind == 3) Ignore(study_->WithdrawConsent(at(subjects_).id, {2026, 6, 1 + choice % 20}, "", NextStamp()));
    if (kind == 4) Ignore(study_->CloseSession(at(sessions_).id, NextStamp()));
    if (kind == 5) Lock({"session", at(sessions_).id.ToString()});
    if (kind == 6) Unlock();
    if (captures_.empty()) return;
    if (kind == 7)
      Ignore(
          study_->AddReport(CountedId<ReportId>(), at(captures_).id, WoundReport(at(captures_), choice), NextStamp()));
    if (kind == 8) Ignore(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), capture, "r", NextStamp()));
    if (kind == 9)
      Ignore(store::ReassignCaptures(study_.record(), std::array{at(captures_).id}, sessions_.front().id, "r", by_,
                                     NextStamp()));
    if (kind == 10)
      Ignore(store::Sign(study_.record(), CountedId<store::SignatureId>(), capture, store::Meaning::kReviewed, by_,
                         NextStamp()));
    if (kind == 11) Ignore(study_->SetRole(at(captures_).id, *CaptureRole::Parse("pose"), "r", NextStamp()));
  }
  SmallStudy& study() { return study_; }

 private:
  using Record = store::Record;
  template <typename T>
  static void Ignore(const Result<T>& result) {
    RC_LOG() << (result ? "done\n" : result.error().Describe() + "\n");
  }
  void Enrol() { subjects_.push_back(study_.EnrolWithConsent("S" + std::to_string(100 + subjects_.size()))); }
  void Import(const Session& session, int bytes) {
    auto added =
        study_->AddCapture(SmallStudy::Photograph(session), Bytes("photograph " + std::to_string(bytes)), NextStamp());
    if (added && !added->already_there) captures_.push_back(added->capture);
  }
  void Lock(const Record::Found& target) {
    Ignore(store::AddLock(study_.record(), CountedId<store::LockId>(), target, "r", by_, NextStamp()));
  }
  void Unlock() {
    const auto locks = store::Locks(study_.record());
    if (locks->empty()) return;
    Ignore(store::Unlock(study_.record(), CountedId<store::UnlockId>(), locks->front().id, "r", by_, NextStamp()));
  }

  SmallStudy study_;
  store::SignedIn by_ = SignedInAs(study_, "anna", store::Role::kInvestigator);
  std::vector<Subject> subjects_ = {study_.EnrolWithConsent("S099")};
  std::vector<Session> sessions_ = {study_.Open(subjects_.front())};
  std::vector<Capture> captures_;
};

RC_GTEST_PROP(AuditTrail, IsWholeAndGivesTheStudyAgainAfterAnyWork, ()) {
  Work work;
  // Few but long runs: a commit is an fsync.
  for (int step = 0; step < 25; ++step) work.Step(*rc::gen::inRange(0, 12), *rc::gen::inRange(0, 100));
  const auto report = work.study()->Check();
  RC_ASSERT(report.has_value() && report->Passed());
  auto again = store::AsOf(work.study().record(), NextStamp().now);
  RC_ASSERT(again.has_value());
  const store::Record::Found whole{"study", work.study()->GetStudy()->id.ToString()};
  RC_ASSERT(*store::ContentHash(*again, whole) == *store::ContentHash(work.study().record(), whole));
}

}  // namespace
}  // namespace striae::testing
