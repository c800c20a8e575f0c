#include "dicom/uid.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <sodium.h>

namespace striae::dicom {

std::string UidOf(const Uuid& uuid) {
  // Long division of the 128-bit number by ten, one decimal digit a round.
  std::array<std::uint8_t, 16> number = uuid.bytes;
  std::string digits;
  do {
    unsigned remainder = 0;
    for (std::uint8_t& byte : number) {
      const unsigned value = 256 * remainder + byte;
      byte = static_cast<std::uint8_t>(value / 10);
      remainder = value % 10;
    }
    digits.push_back(static_cast<char>('0' + remainder));
  } while (std::any_of(number.begin(), number.end(), [](std::uint8_t byte) { return byte != 0; }));
  std::reverse(digits.begin(), digits.end());
  return "2.25." + digits;
}

std::string UidOfContent(std::span<const std::uint8_t> bytes) {
  std::array<std::uint8_t, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), bytes.data(), bytes.size());
  Uuid uuid;
  std::copy_n(digest.begin(), uuid.bytes.size(), uuid.bytes.begin());
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0FU) | 0x80U);  // version 8
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3FU) | 0x80U);  // variant of RFC 9562
  return UidOf(uuid);
}

std::string UidOfName(std::string_view name) {
  const std::string prefixed = "striae-dicom/1/" + std::string(name);
  const auto* data = reinterpret_cast<const std::uint8_t*>(prefixed.data());
  return UidOfContent({data, prefixed.size()});
}

}  // namespace striae::dicom
