// Signatures over content: they break when it changes.
#include <map>

#include "store/detail/scope.h"
#include "store/detail/words.h"
#include "store/locks.h"

namespace striae::store {
namespace {

using State = Signature::State;

Signature ReadSignature(const RowView& row) {
  Signature s;
  s.id = row.Key<SignatureId>(0);
  s.target = {row.Text(1), row.Text(2)};
  s.meaning = detail::Unwrap(ParseMeaning(row.Text(3)));
  s.signer = row.Text(4);
  s.role = row.Text(5);
  s.at = row.Time(6);
  s.content = row.Hash(7);
  s.state = row.Integer(8) != 0 ? State::kVoided : State::kValid;
  return s;
}

}  // namespace

std::string_view ToString(Meaning meaning) { return meaning == Meaning::kApproved ? "approved" : "reviewed"; }

Result<Meaning> ParseMeaning(std::string_view text) {
  for (const Meaning meaning : {Meaning::kReviewed, Meaning::kApproved}) {
    if (ToString(meaning) == text) return meaning;
  }
  return Fail(ErrorCode::kUsage, "a signature means 'reviewed' or 'approved'");
}

std::string_view ToString(State state) {
  switch (state) {
    case State::kValid:
      return "valid";
    case State::kBroken:
      return "broken";
    case State::kVoided:
      return "voided";
  }
  throw std::logic_error("Signature::State");
}

Result<Sha256> ContentHash(Record& record, const Record::Found& target) {
  return Guarded([&] { return detail::ContentHash(Access::Of(record).database, target); });
}

Result<Signature> Sign(Record& record, const SignatureId& id, const Record::Found& target, Meaning meaning,
                       const SignedIn& by, const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(RequireRight(by, Act::kSign));
    Database& database = Access::Of(record).database;
    Stamp signed_stamp = stamp;
    signed_stamp.user = by.user().name;
    Change change(database, signed_stamp);
    Signature s{id,
                target,
                meaning,
                by.user().full_name,
                std::string(ToString(by.user().role)),
                stamp.now,
                detail::ContentHash(database, target),
                State::kValid};
    change.Insert("signature", {{"id", ToValue(id)},
                                {"entity", ToValue(target.entity)},
                                {"entity_id", ToValue(target.id)},
                                {"meaning", ToValue(ToString(meaning))},
                                {"user_id", ToValue(by.user().id)},
                                {"signer", ToValue(s.signer)},
                                {"role", ToValue(s.role)},
                                {"at", ToValue(s.at)},
                                {"content_sha256", ToValue(s.content)}});
    change.Commit();
    return s;
  });
}

Result<std::vector<Signature>> Signatures(Record& record, std::optional<std::string> target) {
  return Guarded([&] {
    Database& database = Access::Of(record).database;
    auto all = database.Rows(
        "SELECT id, entity, entity_id, meaning, signer, role, at, content_sha256, EXISTS (SELECT 1 FROM void_signature "
        "WHERE signature_id = signature.id) FROM signature WHERE ?1 IS NULL OR entity_id = ?1 ORDER BY at, id",
        ReadSignature, target);
    std::map<std::string, Sha256> hashes;
    for (Signature& signature : all) {
      if (signature.state == State::kVoided) continue;
      const auto [place, fresh] = hashes.try_emplace(signature.target.id);
      if (fresh) place->second = detail::ContentHash(database, signature.target);
      if (place->second != signature.content) signature.state = State::kBroken;
    }
    return all;
  });
}

}  // namespace striae::store
