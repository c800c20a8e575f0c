// Users of a study, their roles, and signing in. A study without users works: who did something is then the name that
// the caller's Stamp has. What needs sign-in (Act) asks for a SignedIn, which only SignIn makes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/id.h"
#include "core/result.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

using UserId = Id<struct UserTag>;

enum class Role { kCoordinator, kClinician, kInvestigator, kMonitor, kAdministrator };
std::string_view ToString(Role role);  ///< "coordinator", ...
Result<Role> ParseRole(std::string_view text);

/// What needs sign-in.
enum class Act { kSign, kLock, kUnlock, kReassign, kWithdraw, kManageUsers };
std::string_view ToString(Act act);
/// Whether a role has the right. The table is in docs/record.md.
bool May(Role role, Act act);

struct User {
  UserId id;
  std::string name;       ///< what stands in the audit trail: 1 to 64 characters without spaces
  std::string full_name;  ///< the printed name of a signature
  Role role = Role::kCoordinator;
  bool active = true;
  bool has_passphrase = false;  ///< can sign in
};

/// A user who has just proved who it is. Made by SignIn only.
class SignedIn {
 public:
  [[nodiscard]] const User& user() const { return user_; }

 private:
  friend Result<SignedIn> SignIn(Record& record, std::string_view name, std::string_view passphrase,
                                 const Stamp& stamp);
  explicit SignedIn(User user) : user_(std::move(user)) {}
  User user_;
};

/// Cost of Argon2id (RFC 9106): passes over memory, and memory in bytes.
struct PassphraseCost {
  std::uint64_t passes = 2;
  std::uint64_t memory_bytes = std::uint64_t{64} << 20;
};

Result<std::vector<User>> Users(Record& record);
/// kNotFound, with the names that there are.
Result<User> UserByName(Record& record, std::string_view name);

/// Whether users can be managed without sign-in: as long as no active administrator has a passphrase.
Result<bool> UsersAreOpen(Record& record);

/// Status of the three: kRecordRefused when UsersAreOpen is false and `by` is not a signed-in administrator.
Status AddUser(Record& record, const User& user, const std::optional<SignedIn>& by, const Stamp& stamp);
Status ChangeRole(Record& record, const UserId& id, Role role, const std::string& reason,
                  const std::optional<SignedIn>& by, const Stamp& stamp);
Status SetActive(Record& record, const UserId& id, bool active, const std::string& reason,
                 const std::optional<SignedIn>& by, const Stamp& stamp);
/// At least 8 characters. The user's own signed-in self may change it, else as for AddUser. `salt`: 16 random bytes.
/// Kept is an Argon2id key; the audit trail holds the SHA-256 of that.
Status SetPassphrase(Record& record, const UserId& id, std::string_view passphrase, const Uuid& salt,
                     const std::optional<SignedIn>& by, const Stamp& stamp, const PassphraseCost& cost = {});

/// kRecordRefused for an unknown or inactive user, one without passphrase, and a wrong passphrase (which leaves an
/// audit row). kRecordDamaged when what proves the passphrase is not what the trail says.
Result<SignedIn> SignIn(Record& record, std::string_view name, std::string_view passphrase, const Stamp& stamp);

/// kRecordRefused, naming the roles that have the right, when this user does not.
Status RequireRight(const SignedIn& by, Act act);

}  // namespace striae::store
