// Who the subjects are: name, birth date and hospital number, in a file of their own (identity.striae) that only its
// passphrase opens. Nothing of it stands in study.db, in a log or in any other file, and no daily work needs it.
//
// The file: "STRIAEID", version, Argon2id's passes and memory (RFC 9106), salt, stream header, a MAC of all that with
// one half of the key, then an SQLite database (made in memory, serialised) in chunks of 64 KiB under the other half
// (libsodium's secretstream, XChaCha20-Poly1305), and the SHA-256 of everything before. So damage can be told from a
// wrong passphrase, and a check needs no passphrase.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/id.h"
#include "core/result.h"
#include "core/time.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

struct Identity {
  SubjectId subject;
  std::string pseudonym;
  std::string name;  ///< as the hospital writes it
  std::optional<Date> birth_date;
  std::string hospital_id;  ///< the hospital's number of the person
  UtcTime changed_at;
  std::string changed_by;
};

/// How long a guess takes. The defaults are libsodium's "moderate": about 0.7 s and 256 MiB a try.
struct IdentityCost {
  std::uint64_t passes = 3, memory_bytes = std::uint64_t{256} << 20;
};

/// 16 bytes of salt and 24 of stream header, drawn in app/ anew for every write.
using IdentityRandom = std::array<std::uint8_t, 40>;

inline constexpr std::size_t kShortestPassphrase = 8;

/// Everybody in the file, by pseudonym; empty when there is no file. kRecordRefused for a wrong passphrase,
/// kRecordDamaged for a file that was cut or altered, kRecordRefused for one of a newer version.
Result<std::vector<Identity>> ReadIdentities(const std::filesystem::path& file, std::string_view passphrase);

/// Replaces the file as a whole (temporary file, fsync, rename). Any failure leaves it as it was. kUsage for a
/// passphrase of fewer than kShortestPassphrase characters.
Status WriteIdentities(const std::filesystem::path& file, const std::vector<Identity>& identities,
                       std::string_view passphrase, const IdentityRandom& random, const IdentityCost& cost = {});

/// Replaces everybody in the study's file by what `edit` makes of them. Two programs that change it at once do so one
/// after the other (a lock on the study's folder; waits up to a minute, then kIo). The trail gets a row that says when,
/// who, whether "set" or "passphrase", and the new file's SHA-256, but nothing of its content; the row is written
/// before the file gets its name, so that no change is without one. `edit` may refuse; then nothing has changed.
struct IdentityChange {
  std::string_view passphrase;      ///< of the file as it is
  std::string_view new_passphrase;  ///< from now on; the same when empty
  std::function<Status(std::vector<Identity>&)> edit;
  IdentityRandom random{};
  IdentityCost cost;
};
Status ChangeIdentities(Record& record, const IdentityChange& change, const Stamp& stamp);

/// Whether the file is whole, without its passphrase: kRecordDamaged with where it is not.
Status CheckIdentityFile(const std::filesystem::path& file);

inline constexpr const char* kIdentityName = "identity.striae";

}  // namespace striae::store
