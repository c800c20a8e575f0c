#include "store/users.h"

#include <algorithm>
#include <array>

#include "store/detail/codec.h"
#include "store/detail/passphrase.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr std::array kRoles = {Role::kCoordinator, Role::kClinician, Role::kInvestigator, Role::kMonitor,
                               Role::kAdministrator};
constexpr std::size_t kShortestPassphrase = 8, kLongestName = 64;
constexpr const char* kUsers =
    "SELECT id, name, full_name, role, active, EXISTS (SELECT 1 FROM credential WHERE user_id = user.id) FROM user";

User ReadUser(const RowView& row) {
  return {row.Key<UserId>(0),  row.Text(1),        row.Text(2), detail::Unwrap(ParseRole(row.Text(3))),
          row.Integer(4) != 0, row.Integer(5) != 0};
}

User GetUser(Database& database, const UserId& id) {
  auto user = database.One(std::string(kUsers) + " WHERE id = ?", ReadUser, id);
  if (!user) Refuse(ErrorCode::kNotFound, "no user " + id.ToString() + " in this study; see 'striae user list'");
  return *std::move(user);
}

bool Open(Database& database) {
  return database.Count(
             "SELECT count(*) FROM user WHERE role = 'administrator' AND active = 1 AND id IN (SELECT user_id FROM "
             "credential)") == 0;
}

void RefuseUnlessManager(Database& database, const std::optional<SignedIn>& by) {
  if (Open(database)) return;
  if (!by) {
    Refuse(ErrorCode::kRecordRefused,
           "this study has an administrator: only one who signs in manages users; give --user NAME and the passphrase");
  }
  detail::Unwrap(RequireRight(*by, Act::kManageUsers));
}

void RefuseBadName(const std::string& name) {
  const bool good = !name.empty() && name.size() <= kLongestName &&
                    std::none_of(name.begin(), name.end(), [](char c) { return c >= 0 && c <= ' '; });
  if (!good) Refuse(ErrorCode::kUsage, "a user's name has 1 to 64 characters without spaces");
}

void ChangeOf(Database& database, const UserId& id, const std::string& column, const detail::Value& value,
              const std::string& reason, const std::optional<SignedIn>& by, const Stamp& stamp) {
  detail::RequireReason(reason, "a change of a user");
  Change change(database, stamp);
  RefuseUnlessManager(database, by);
  GetUser(database, id);
  change.Set("user", id.ToString(), column, value, reason);
  change.Commit();
}

}  // namespace

std::string_view ToString(Role role) {
  switch (role) {
    case Role::kCoordinator:
      return "coordinator";
    case Role::kClinician:
      return "clinician";
    case Role::kInvestigator:
      return "investigator";
    case Role::kMonitor:
      return "monitor";
    case Role::kAdministrator:
      return "administrator";
  }
  throw std::logic_error("Role");
}

Result<Role> ParseRole(std::string_view text) {
  for (const Role role : kRoles) {
    if (ToString(role) == text) return role;
  }
  return Fail(ErrorCode::kUsage, "no role '" + std::string(text.substr(0, 40)) +
                                     "'; a role is coordinator, clinician, investigator, monitor or administrator");
}

std::string_view ToString(Act act) {
  switch (act) {
    case Act::kSign:
      return "sign";
    case Act::kLock:
      return "lock";
    case Act::kUnlock:
      return "unlock";
    case Act::kReassign:
      return "reassign";
    case Act::kWithdraw:
      return "enter a withdrawal of consent";
    case Act::kManageUsers:
      return "manage users";
  }
  throw std::logic_error("Act");
}

bool May(Role role, Act act) {
  switch (act) {
    case Act::kSign:
      return role == Role::kClinician || role == Role::kInvestigator || role == Role::kMonitor;
    case Act::kLock:
      return role != Role::kClinician;
    case Act::kUnlock:
      return role == Role::kInvestigator || role == Role::kAdministrator;
    case Act::kReassign:
      return role != Role::kClinician && role != Role::kMonitor;
    case Act::kWithdraw:
      return role != Role::kMonitor;
    case Act::kManageUsers:
      return role == Role::kAdministrator;
  }
  throw std::logic_error("Act");
}

Status RequireRight(const SignedIn& by, Act act) {
  if (May(by.user().role, act)) return {};
  std::string roles;
  for (const Role role : kRoles) {
    if (May(role, act)) roles += (roles.empty() ? "" : ", ") + std::string(ToString(role));
  }
  return Fail(ErrorCode::kRecordRefused, by.user().name + " is " + std::string(ToString(by.user().role)) +
                                             " and may not " + std::string(ToString(act)) +
                                             "; these roles may: " + roles);
}

Result<std::vector<User>> Users(Record& record) {
  return Guarded([&] { return Access::Of(record).database.Rows(std::string(kUsers) + " ORDER BY name", ReadUser); });
}

Result<User> UserByName(Record& record, std::string_view name) {
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    auto user = database.One(std::string(kUsers) + " WHERE name = ?", ReadUser, name);
    if (!user) {
      const bool none = database.Count("SELECT count(*) FROM user") == 0;
      Refuse(ErrorCode::kNotFound,
             none ? "this study has no users yet; add the first with 'striae user add NAME --role ROLE'"
                  : "no user '" + std::string(name.substr(0, 40)) + "' in this study; see 'striae user list'");
    }
    return *std::move(user);
  });
}

Result<bool> UsersAreOpen(Record& record) {
  return Guarded([&] { return Open(Access::Of(record).database); });
}

Status AddUser(Record& record, const User& user, const std::optional<SignedIn>& by, const Stamp& stamp) {
  return Guarded([&] {
    RefuseBadName(user.name);
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    RefuseUnlessManager(database, by);
    if (database.Count("SELECT count(*) FROM user WHERE name = ?", user.name) != 0) {
      Refuse(ErrorCode::kRecordRefused, "there is a user " + user.name + " already; see 'striae user list'");
    }
    change.Insert("user", {{"id", ToValue(user.id)},
                           {"name", ToValue(user.name)},
                           {"full_name", ToValue(user.full_name.empty() ? user.name : user.full_name)},
                           {"role", ToValue(ToString(user.role))},
                           {"active", ToValue(1)}});
    change.Commit();
  });
}

Status ChangeRole(Record& record, const UserId& id, Role role, const std::string& reason,
                  const std::optional<SignedIn>& by, const Stamp& stamp) {
  return Guarded(
      [&] { ChangeOf(Access::Of(record).database, id, "role", ToValue(ToString(role)), reason, by, stamp); });
}

Status SetActive(Record& record, const UserId& id, bool active, const std::string& reason,
                 const std::optional<SignedIn>& by, const Stamp& stamp) {
  return Guarded(
      [&] { ChangeOf(Access::Of(record).database, id, "active", ToValue(active ? 1 : 0), reason, by, stamp); });
}

Status SetPassphrase(Record& record, const UserId& id, std::string_view passphrase, const Uuid& salt,
                     const std::optional<SignedIn>& by, const Stamp& stamp, const PassphraseCost& cost) {
  return Guarded([&] {
    if (passphrase.size() < kShortestPassphrase) {
      Refuse(ErrorCode::kUsage, "a passphrase needs at least 8 characters; a few words are better");
    }
    const std::string verifier = detail::MakeVerifier(passphrase, salt, cost);
    const Sha256 hash = HashOf({reinterpret_cast<const std::uint8_t*>(verifier.data()), verifier.size()});
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    const User user = GetUser(database, id);
    if (!by || by->user().id != id) RefuseUnlessManager(database, by);
    const auto number = detail::NextNumber(database, "credential", "user_id", id.ToString());
    const std::string credential = detail::UuidFrom({"credential", id.ToString(), hash.ToString()}).ToString();
    change.Insert(
        "credential",
        {{"id", ToValue(credential)}, {"user_id", ToValue(id)}, {"number", number}, {"verifier_sha256", ToValue(hash)}},
        user.has_passphrase ? "new passphrase" : "");
    database.Run("INSERT INTO verifier (credential_id, text) VALUES (?, ?)", {credential, verifier});
    change.Commit();
  });
}

Result<SignedIn> SignIn(Record& record, std::string_view name, std::string_view passphrase, const Stamp& stamp) {
  const auto found = UserByName(record, name);
  if (!found) return Fail(found.error());
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    if (!found->active) Refuse(ErrorCode::kRecordRefused, found->name + " is no active user; ask the administrator");
    if (!found->has_passphrase) {
      Refuse(ErrorCode::kRecordRefused,
             found->name + " has no passphrase yet; set it with 'striae user passphrase " + found->name + "'");
    }
    struct Kept {
      std::string text, sha256;
    };
    const auto kept = database.One(
        "SELECT v.text, c.verifier_sha256 FROM credential c JOIN verifier v ON v.credential_id = c.id "
        "WHERE c.user_id = ? ORDER BY c.number DESC LIMIT 1",
        [](const RowView& row) {
          return Kept{row.Text(0), row.Text(1)};
        },
        found->id);
    if (!kept || HashOf({reinterpret_cast<const std::uint8_t*>(kept->text.data()), kept->text.size()}).ToString() !=
                     kept->sha256) {
      Refuse(ErrorCode::kRecordDamaged,
             "what proves the passphrase of " + found->name + " was altered past the audit trail; run 'striae check'");
    }
    if (!detail::Verifies(passphrase, kept->text)) {
      Change change(database, stamp);
      change.Note("sign-in", found->name, "", "wrong passphrase");
      change.Commit();
      Refuse(ErrorCode::kRecordRefused, "wrong passphrase for " + found->name + "; the attempt is in the audit trail");
    }
    return SignedIn(*found);
  });
}

}  // namespace striae::store
