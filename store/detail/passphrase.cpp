#include "store/detail/passphrase.h"

#include <array>
#include <charconv>
#include <vector>

#include <sodium.h>

#include "core/hex.h"
#include "store/detail/failed.h"

namespace striae::store::detail {
namespace {

static_assert(crypto_pwhash_argon2id_SALTBYTES == 16, "a Uuid is the salt");
constexpr std::string_view kName = "argon2id13";

using Key = std::array<std::uint8_t, 32>;

Key Derive(std::string_view passphrase, const Uuid& salt, const PassphraseCost& cost) {
  if (sodium_init() < 0) Refuse(ErrorCode::kInternal, "libsodium could not start");
  Key key{};
  if (crypto_pwhash_argon2id(key.data(), key.size(), passphrase.data(), passphrase.size(), salt.bytes.data(),
                             cost.passes, static_cast<std::size_t>(cost.memory_bytes),
                             crypto_pwhash_argon2id_ALG_ARGON2ID13) != 0) {
    Refuse(ErrorCode::kInternal, "not enough memory to check a passphrase (it takes " +
                                     std::to_string(cost.memory_bytes >> 20) + " MiB); close other programs");
  }
  return key;
}

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  parts.push_back(text.substr(from));
  return parts;
}

std::string Hex(const Key& key) { return Sha256{key}.ToString(); }

[[noreturn]] void RefuseUnreadable() {
  Refuse(ErrorCode::kRecordDamaged, "what proves this user's passphrase cannot be read; run 'striae check'");
}

std::uint64_t Number(const std::string& text) {
  std::uint64_t value = 0;
  const auto end = text.data() + text.size();
  if (const auto read = std::from_chars(text.data(), end, value); read.ec != std::errc() || read.ptr != end) {
    RefuseUnreadable();
  }
  return value;
}

}  // namespace

std::string MakeVerifier(std::string_view passphrase, const Uuid& salt, const PassphraseCost& cost) {
  std::string text(kName);
  text.append("$").append(std::to_string(cost.passes)).append("$").append(std::to_string(cost.memory_bytes));
  return text.append("$").append(salt.ToString()).append("$").append(Hex(Derive(passphrase, salt, cost)));
}

bool Verifies(std::string_view passphrase, const std::string& verifier) {
  const auto parts = Split(verifier);
  if (parts.size() != 5 || parts[0] != kName) RefuseUnreadable();
  const auto salt = Uuid::Parse(parts[3]);
  const auto kept = Sha256::Parse(parts[4]);
  if (!salt || !kept) RefuseUnreadable();
  const Key key = Derive(passphrase, *salt, {Number(parts[1]), Number(parts[2])});
  return sodium_memcmp(key.data(), kept->bytes.data(), key.size()) == 0;
}

}  // namespace striae::store::detail
