// What proves a passphrase without holding it.
#pragma once

#include <string>
#include <string_view>

#include "core/id.h"
#include "store/users.h"

namespace striae::store::detail {

/// "argon2id13$<passes>$<memory bytes>$<salt, hex>$<key, hex>"; Argon2id (RFC 9106) by libsodium. Throws Failed when
/// the memory is not there.
std::string MakeVerifier(std::string_view passphrase, const Uuid& salt, const PassphraseCost& cost);

/// Compared in constant time. Throws Failed (kRecordDamaged) when the verifier cannot be read.
bool Verifies(std::string_view passphrase, const std::string& verifier);

}  // namespace striae::store::detail
