// Who may do what, and how it is proved.
#include "tests/store/signed_in.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

using store::Act;
using store::May;
using store::Role;

TEST(Users, SignInWithTheirPassphraseAndNoOther) {
  SmallStudy study;
  AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  const auto by = store::SignIn(study.record(), "anna", kPassphrase, NextStamp());
  ASSERT_THAT(by, IsOk());
  EXPECT_EQ(by->user().full_name, "Test anna");
  EXPECT_THAT(store::SignIn(study.record(), "anna", "correct horse batterz", NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "wrong passphrase"));
  EXPECT_THAT(store::SignIn(study.record(), "bert", kPassphrase, NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no user 'bert'"));
  EXPECT_TRUE(study->Check()->Passed());
}

TEST(Users, AWrongPassphraseLeavesAnAuditRow) {
  SmallStudy study;
  AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  const auto before = study->Head()->sequence;
  EXPECT_FALSE(store::SignIn(study.record(), "anna", "something else", NextStamp()));
  EXPECT_EQ(study->Head()->sequence, before + 1);
}

TEST(Users, ThePassphraseIsNowhereInTheStudyAndItsProofNotInTheTrail) {
  SmallStudy study;
  const store::User anna = AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  for (const store::AuditRow& row : std::vector(*study->History(anna.id.ToString()))) {
    EXPECT_EQ(row.new_value.value_or("").find("argon2"), std::string::npos) << row.entity;
  }
  study.Close();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(study.folder())) {
    if (!entry.is_regular_file()) continue;
    const auto bytes = ReadBytes(entry.path());
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()).find(kPassphrase), std::string::npos) << entry.path();
  }
}

TEST(Users, AProofPutInPastTheTrailDoesNotSignIn) {
  SmallStudy study;
  AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  ASSERT_EQ(RawSql(study.database(),
                   "DROP TRIGGER verifier_no_update; UPDATE verifier SET text = replace(text, '$1$', '$2$')"),
            "");
  EXPECT_THAT(store::SignIn(study.record(), "anna", kPassphrase, NextStamp()),
              FailsWith(ErrorCode::kRecordDamaged, "altered past the audit trail"));
}

TEST(Users, AreOpenToAllUntilAnAdministratorCanSignIn) {
  SmallStudy study;
  EXPECT_TRUE(*store::UsersAreOpen(study.record()));
  const auto boss = SignedInAs(study, "boss", Role::kAdministrator);
  const store::User bert{CountedId<store::UserId>(), "bert", "", Role::kMonitor, true, false};
  EXPECT_THAT(store::AddUser(study.record(), bert, {}, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "only one who signs in manages users"));
  ASSERT_THAT(store::AddUser(study.record(), bert, boss, NextStamp()), IsOk());
  ASSERT_THAT(store::SetPassphrase(study.record(), bert.id, "another phrase", CountedUuid(), boss, NextStamp(), kCheap),
              IsOk());
  const auto by_bert = store::SignIn(study.record(), "bert", "another phrase", NextStamp());
  ASSERT_THAT(by_bert, IsOk());
  EXPECT_THAT(store::ChangeRole(study.record(), bert.id, Role::kAdministrator, "I want to", *by_bert, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "may not manage users"));
  EXPECT_THAT(
      store::SetPassphrase(study.record(), bert.id, "my own phrase", CountedUuid(), *by_bert, NextStamp(), kCheap),
      IsOk())
      << "everyone changes the own passphrase";
}

TEST(Users, WhoIsNotActiveDoesNotSignInAnyMore) {
  SmallStudy study;
  const store::User anna = AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  EXPECT_THAT(store::SetActive(study.record(), anna.id, false, "", {}, NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::SetActive(study.record(), anna.id, false, "left the study", {}, NextStamp()), IsOk());
  EXPECT_THAT(store::SignIn(study.record(), "anna", kPassphrase, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "no active user"));
}

TEST(Users, NoRoleHasEveryRight) {
  EXPECT_TRUE(May(Role::kInvestigator, Act::kSign));
  EXPECT_FALSE(May(Role::kCoordinator, Act::kSign)) << "who enters data does not approve it";
  EXPECT_FALSE(May(Role::kAdministrator, Act::kSign));
  EXPECT_FALSE(May(Role::kMonitor, Act::kReassign)) << "a monitor asks, and changes nothing";
  EXPECT_FALSE(May(Role::kCoordinator, Act::kUnlock));
  EXPECT_FALSE(May(Role::kInvestigator, Act::kManageUsers));
}

TEST(Users, AreNamedOnceAndWithoutSpaces) {
  SmallStudy study;
  AddUserWithPassphrase(study, "anna", Role::kInvestigator);
  const auto add = [&](const std::string& name) {
    return store::AddUser(study.record(), {CountedId<store::UserId>(), name, "", Role::kMonitor, true, false}, {},
                          NextStamp());
  };
  EXPECT_THAT(add("Anna"), FailsWith(ErrorCode::kRecordRefused, "a user Anna already"));
  EXPECT_THAT(add("an na"), FailsWith(ErrorCode::kUsage, "without spaces"));
  EXPECT_THAT(add(""), FailsWith(ErrorCode::kUsage, "1 to 64"));
}

}  // namespace
}  // namespace striae::testing
