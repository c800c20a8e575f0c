// Locks and signatures. Both need a signed-in user with the right (store/users.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "store/record.h"
#include "store/users.h"

namespace striae::store {

using LockId = Id<struct LockTag>;
using UnlockId = Id<struct UnlockTag>;
using SignatureId = Id<struct SignatureTag>;

/// Of a study, subject, visit or session. While it holds, triggers in study.db refuse every new or changed capture,
/// outline, derived file, outcome, measurement, exclusion, treatment, arm, session and visit below it, in whatever
/// program. Consent, notes, queries and signatures stay possible.
struct Lock {
  LockId id;
  Record::Found target;
  std::string reason, by;
  UtcTime at;
};

Status AddLock(Record& record, const LockId& id, const Record::Found& target, const std::string& reason,
               const SignedIn& by, const Stamp& stamp);
/// Ends a lock with a reason, and voids the signatures on what was locked and below it.
Status Unlock(Record& record, const UnlockId& id, const LockId& lock, const std::string& reason, const SignedIn& by,
              const Stamp& stamp);
/// That hold.
Result<std::vector<Lock>> Locks(Record& record);

enum class Meaning { kReviewed, kApproved };
std::string_view ToString(Meaning meaning);
Result<Meaning> ParseMeaning(std::string_view text);

struct Signature {
  enum class State {
    kValid,   ///< what was signed is as it was
    kBroken,  ///< it changed since
    kVoided,  ///< it was unlocked since
  };
  SignatureId id;
  Record::Found target;
  Meaning meaning = Meaning::kReviewed;
  std::string signer, role;  ///< printed name and role when it was signed
  UtcTime at;
  Sha256 content;  ///< ContentHash of the target then
  State state = State::kValid;
};
std::string_view ToString(Signature::State state);

/// SHA-256 over every row that belongs to a study, subject, visit, session or capture: the thing itself, what lies
/// below it, outlines, derived files, outcomes, measurements, exclusions, treatments, consent. docs/record.md has the
/// bytes. Notes, queries, locks and signatures are not part of it.
Result<Sha256> ContentHash(Record& record, const Record::Found& target);

/// Signs what `target` is now. kRecordRefused for anything but a study, subject, visit, session or capture.
Result<Signature> Sign(Record& record, const SignatureId& id, const Record::Found& target, Meaning meaning,
                       const SignedIn& by, const Stamp& stamp);
/// Each with its state now; of one target (by its id), or all.
Result<std::vector<Signature>> Signatures(Record& record, std::optional<std::string> target = std::nullopt);

}  // namespace striae::store
