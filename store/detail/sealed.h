// Bytes under a passphrase: Argon2id and secretstream. The format is described in store/identity.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "store/identity.h"

namespace striae::store::detail {

/// Memory that is kept out of swap and core files where the system allows it, and wiped when it goes (sodium_malloc).
class SecretBytes {
 public:
  explicit SecretBytes(std::size_t size);
  ~SecretBytes();
  SecretBytes(const SecretBytes&) = delete;
  SecretBytes& operator=(const SecretBytes&) = delete;
  SecretBytes(SecretBytes&& other) noexcept : data_(other.data_), size_(other.size_) {
    other.data_ = nullptr;
    other.size_ = 0;
  }
  SecretBytes& operator=(SecretBytes&&) = delete;
  [[nodiscard]] std::uint8_t* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::uint8_t* data_;
  std::size_t size_;
};

std::vector<std::uint8_t> Seal(std::span<const std::uint8_t> plain, std::string_view passphrase,
                               const IdentityRandom& random, const IdentityCost& cost);
/// Throws Failed: kRecordDamaged or kRecordRefused, as ReadIdentities says.
SecretBytes Unseal(std::span<const std::uint8_t> sealed, std::string_view passphrase);
/// Magic, version, length and checksum only.
void CheckSealed(std::span<const std::uint8_t> sealed);

}  // namespace striae::store::detail
