#include "store/detail/sealed.h"

#include <algorithm>
#include <cstring>
#include <new>

#include <sodium.h>

#include "store/detail/failed.h"
#include "store/objects.h"

namespace striae::store::detail {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'S', 'T', 'R', 'I', 'A', 'E', 'I', 'D'};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kSalt = crypto_pwhash_SALTBYTES;
constexpr std::size_t kStreamHeader = crypto_secretstream_xchacha20poly1305_HEADERBYTES;
static_assert(kSalt + kStreamHeader == std::tuple_size_v<IdentityRandom>);
constexpr std::size_t kHead = kMagic.size() + 1 + 16 + kSalt + kStreamHeader;  // what the MAC covers
constexpr std::size_t kMac = crypto_auth_BYTES;
constexpr std::size_t kChecksum = 32;
constexpr std::size_t kChunk = 65536;
constexpr std::size_t kSealedChunk = kChunk + crypto_secretstream_xchacha20poly1305_ABYTES;
constexpr std::size_t kKey = 32;
// What a file may ask for: a forged head must not take the machine down.
constexpr std::uint64_t kMostPasses = 20, kMostMemory = std::uint64_t{2} << 30;

void PutNumber(std::vector<std::uint8_t>& to, std::uint64_t number) {
  for (int shift = 0; shift < 64; shift += 8) to.push_back(static_cast<std::uint8_t>(number >> shift));
}

std::uint64_t GetNumber(const std::uint8_t* from) {
  std::uint64_t number = 0;
  for (int i = 7; i >= 0; --i) number = number << 8 | from[i];
  return number;
}

[[noreturn]] void Damaged(const std::string& what) {
  Refuse(ErrorCode::kRecordDamaged,
         std::string(kIdentityName) + " " + what + "; it was not touched, restore it from a backup");
}

/// 32 bytes for the stream, 32 for the head's MAC.
SecretBytes KeyFrom(std::string_view passphrase, const std::uint8_t* salt, const IdentityCost& cost) {
  SecretBytes key(2 * kKey);
  if (crypto_pwhash(key.data(), key.size(), passphrase.data(), passphrase.size(), salt, cost.passes,
                    static_cast<std::size_t>(cost.memory_bytes), crypto_pwhash_ALG_ARGON2ID13) != 0) {
    Refuse(ErrorCode::kIo, "there is not enough memory to open " + std::string(kIdentityName) + " (" +
                               std::to_string(cost.memory_bytes >> 20) + " MiB); close other programs");
  }
  return key;
}

void InitStream(crypto_secretstream_xchacha20poly1305_state& state, const std::uint8_t* header,
                const SecretBytes& key) {
  // init_push draws the header itself; here it is handed in, and both directions begin in the same state.
  crypto_secretstream_xchacha20poly1305_init_pull(&state, header, key.data());
}

}  // namespace

SecretBytes::SecretBytes(std::size_t size) : size_(size) {
  if (sodium_init() < 0) throw std::bad_alloc();
  data_ = static_cast<std::uint8_t*>(sodium_malloc(std::max<std::size_t>(size, 1)));
  if (data_ == nullptr) throw std::bad_alloc();
}

SecretBytes::~SecretBytes() {
  if (data_ != nullptr) sodium_free(data_);
}

std::vector<std::uint8_t> Seal(std::span<const std::uint8_t> plain, std::string_view passphrase,
                               const IdentityRandom& random, const IdentityCost& cost) {
  std::vector<std::uint8_t> sealed(kMagic.begin(), kMagic.end());
  sealed.push_back(kVersion);
  PutNumber(sealed, cost.passes);
  PutNumber(sealed, cost.memory_bytes);
  sealed.insert(sealed.end(), random.begin(), random.end());
  const SecretBytes key = KeyFrom(passphrase, random.data(), cost);
  sealed.resize(kHead + kMac);
  crypto_auth(sealed.data() + kHead, sealed.data(), kHead, key.data() + kKey);
  crypto_secretstream_xchacha20poly1305_state state;
  InitStream(state, random.data() + kSalt, key);
  for (std::size_t at = 0;; at += kChunk) {
    const std::size_t size = std::min(kChunk, plain.size() - at);
    const bool last = at + size == plain.size();
    const std::size_t begin = sealed.size();
    sealed.resize(begin + size + crypto_secretstream_xchacha20poly1305_ABYTES);
    crypto_secretstream_xchacha20poly1305_push(&state, sealed.data() + begin, nullptr, plain.data() + at, size, nullptr,
                                               0, last ? crypto_secretstream_xchacha20poly1305_TAG_FINAL : 0);
    if (last) break;
  }
  sodium_memzero(&state, sizeof state);
  const Sha256 checksum = store::HashOf(sealed);
  sealed.insert(sealed.end(), checksum.bytes.begin(), checksum.bytes.end());
  return sealed;
}

void CheckSealed(std::span<const std::uint8_t> sealed) {
  if (sealed.size() < kMagic.size() + 1 || !std::equal(kMagic.begin(), kMagic.end(), sealed.begin())) {
    Damaged("is not an identity file: its first bytes are others");
  }
  if (sealed[kMagic.size()] > kVersion) {
    Refuse(ErrorCode::kRecordRefused, std::string(kIdentityName) + " was written by a newer Striae; install that");
  }
  if (sealed.size() < kHead + kMac + crypto_secretstream_xchacha20poly1305_ABYTES + kChecksum) {
    Damaged("was cut: only " + std::to_string(sealed.size()) + " bytes are left");
  }
  const auto covered = sealed.first(sealed.size() - kChecksum);
  if (std::memcmp(store::HashOf(covered).bytes.data(), sealed.data() + covered.size(), kChecksum) != 0) {
    Damaged("was cut or altered: its " + std::to_string(sealed.size()) + " bytes do not give its checksum");
  }
}

SecretBytes Unseal(std::span<const std::uint8_t> sealed, std::string_view passphrase) {
  CheckSealed(sealed);
  const std::uint8_t* numbers = sealed.data() + kMagic.size() + 1;
  const IdentityCost cost{GetNumber(numbers), GetNumber(numbers + 8)};
  if (cost.passes < 1 || cost.passes > kMostPasses || cost.memory_bytes < crypto_pwhash_MEMLIMIT_MIN ||
      cost.memory_bytes > kMostMemory) {
    Damaged("was altered: it asks for " + std::to_string(cost.memory_bytes >> 20) + " MiB");
  }
  const std::uint8_t* salt = numbers + 16;
  const SecretBytes key = KeyFrom(passphrase, salt, cost);
  if (crypto_auth_verify(sealed.data() + kHead, sealed.data(), kHead, key.data() + kKey) != 0) {
    Refuse(ErrorCode::kRecordRefused,
           "the passphrase does not open " + std::string(kIdentityName) + "; nothing was changed, type it again");
  }
  crypto_secretstream_xchacha20poly1305_state state;
  InitStream(state, salt + kSalt, key);
  auto rest = sealed.subspan(kHead + kMac, sealed.size() - kHead - kMac - kChecksum);
  const std::size_t chunks = (rest.size() + kSealedChunk - 1) / kSealedChunk;
  SecretBytes plain(rest.size() - std::min(rest.size(), chunks * crypto_secretstream_xchacha20poly1305_ABYTES));
  std::size_t written = 0;
  unsigned char tag = 0;
  while (!rest.empty()) {
    const std::size_t size = std::min(kSealedChunk, rest.size());
    if (size < crypto_secretstream_xchacha20poly1305_ABYTES ||
        crypto_secretstream_xchacha20poly1305_pull(&state, plain.data() + written, nullptr, &tag, rest.data(), size,
                                                   nullptr, 0) != 0) {
      Damaged("was forged: its content does not fit its key");
    }
    written += size - crypto_secretstream_xchacha20poly1305_ABYTES;
    rest = rest.subspan(size);
  }
  sodium_memzero(&state, sizeof state);
  if (tag != crypto_secretstream_xchacha20poly1305_TAG_FINAL) Damaged("was cut: its end is missing");
  return plain;
}

}  // namespace striae::store::detail
