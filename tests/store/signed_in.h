// A user who has signed in, for tests of what needs that.
#pragma once

#include "store/users.h"
#include "tests/store/small_study.h"

namespace striae::testing {

/// The cheapest Argon2id that libsodium computes: the tests are about rules, not about strength.
inline constexpr store::PassphraseCost kCheap{1, 8192};
inline constexpr const char* kPassphrase = "correct horse battery";

inline store::User AddUserWithPassphrase(SmallStudy& study, const std::string& name, store::Role role) {
  const store::User user{CountedId<store::UserId>(), name, "Test " + name, role, true, false};
  EXPECT_THAT(store::AddUser(study.record(), user, {}, NextStamp()), IsOk());
  EXPECT_THAT(store::SetPassphrase(study.record(), user.id, kPassphrase, CountedUuid(), {}, NextStamp(), kCheap),
              IsOk());
  return user;
}

inline store::SignedIn SignedInAs(SmallStudy& study, const std::string& name, store::Role role) {
  AddUserWithPassphrase(study, name, role);
  return *store::SignIn(study.record(), name, kPassphrase, NextStamp());
}

}  // namespace striae::testing
