// Locks: the triggers that keep them are in migration 005.
#include "store/locks.h"

#include "store/detail/codec.h"
#include "store/detail/require.h"
#include "store/detail/scope.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kLocks = "SELECT id, entity, entity_id, reason, by, at FROM lock_now";

Lock ReadLock(const RowView& row) {
  return {row.Key<LockId>(0), {row.Text(1), row.Text(2)}, row.Text(3), row.Text(4), row.Time(5)};
}

/// The audit trail's "who" is the user who signed in.
Stamp StampOf(const SignedIn& by, const Stamp& stamp) {
  Stamp signed_stamp = stamp;
  signed_stamp.user = by.user().name;
  return signed_stamp;
}

void VoidSignatures(Change& change, Database& database, const Lock& lock, const UnlockId& unlock) {
  const auto places = detail::EntitiesWithin(database, lock.target);
  const auto signatures = database.Rows(
      "SELECT id, entity_id FROM signature WHERE id NOT IN (SELECT signature_id FROM void_signature) ORDER BY at, id",
      [](const RowView& row) { return std::pair(row.Text(0), row.Text(1)); });
  for (const auto& [id, entity_id] : signatures) {
    if (!places.contains(entity_id)) continue;
    change.Insert("void_signature", {{"id", ToValue(detail::UuidFrom({"void", id, unlock.ToString()}).ToString())},
                                     {"signature_id", ToValue(id)},
                                     {"unlock_id", ToValue(unlock)}});
  }
}

}  // namespace

Status AddLock(Record& record, const LockId& id, const Record::Found& target, const std::string& reason,
               const SignedIn& by, const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(RequireRight(by, Act::kLock));
    detail::RequireReason(reason, "a lock");
    if (target.entity != "study" && target.entity != "subject" && target.entity != "visit" &&
        target.entity != "session") {
      Refuse(ErrorCode::kUsage, "a study, subject, visit or session is locked, not a " + target.entity);
    }
    Database& database = Access::Of(record).database;
    const Stamp signed_stamp = StampOf(by, stamp);
    Change change(database, signed_stamp);
    if (database.Count("SELECT count(*) FROM lock_now WHERE entity_id = ?", target.id) != 0) {
      Refuse(ErrorCode::kRecordRefused, "this " + target.entity + " is locked already; see 'striae lock list'");
    }
    change.Insert("lock",
                  {{"id", ToValue(id)},
                   {"entity", ToValue(target.entity)},
                   {"entity_id", ToValue(target.id)},
                   {"reason", ToValue(reason)},
                   {"by", ToValue(signed_stamp.user)},
                   {"at", ToValue(stamp.now)}},
                  reason);
    change.Commit();
  });
}

Status Unlock(Record& record, const UnlockId& id, const LockId& lock, const std::string& reason, const SignedIn& by,
              const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(RequireRight(by, Act::kUnlock));
    detail::RequireReason(reason, "an unlock");
    Database& database = Access::Of(record).database;
    const Stamp signed_stamp = StampOf(by, stamp);
    Change change(database, signed_stamp);
    const auto held = database.One(std::string(kLocks) + " WHERE id = ?", ReadLock, lock);
    if (!held) Refuse(ErrorCode::kNotFound, "no lock " + lock.ToString() + " holds; see 'striae lock list'");
    change.Insert("unlock",
                  {{"id", ToValue(id)},
                   {"lock_id", ToValue(lock)},
                   {"reason", ToValue(reason)},
                   {"by", ToValue(signed_stamp.user)},
                   {"at", ToValue(stamp.now)}},
                  reason);
    VoidSignatures(change, database, *held, id);
    change.Commit();
  });
}

Result<std::vector<Lock>> Locks(Record& record) {
  return Guarded([&] { return Access::Of(record).database.Rows(std::string(kLocks) + " ORDER BY at, id", ReadLock); });
}

}  // namespace striae::store
