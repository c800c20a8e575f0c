#include "core/id.h"

#include <algorithm>

#include "core/hex.h"

namespace striae {
namespace {
constexpr bool IsDash(std::size_t position) {
  return position == 8 || position == 13 || position == 18 || position == 23;
}
}  // namespace

Uuid Uuid::FromRandom(std::span<const std::uint8_t, 16> random) {
  Uuid uuid;
  std::copy(random.begin(), random.end(), uuid.bytes.begin());
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0f) | 0x40);
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3f) | 0x80);
  return uuid;
}

Result<Uuid> Uuid::Parse(std::string_view text) {
  const std::string shown(text.substr(0, 40));
  if (text.size() != 36) return Fail(ErrorCode::kBadFile, "'" + shown + "' is not an id (36 characters, 8-4-4-4-12)");
  std::string digits;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (IsDash(i) != (text[i] == '-')) return Fail(ErrorCode::kBadFile, "'" + shown + "' is not an id (8-4-4-4-12)");
    if (text[i] != '-') digits += text[i];
  }
  Uuid uuid;
  if (!FromHex(digits, uuid.bytes)) return Fail(ErrorCode::kBadFile, "'" + shown + "' is not an id (not hexadecimal)");
  return uuid;
}

std::string Uuid::ToString() const {
  const std::string digits = ToHex(bytes);
  return digits.substr(0, 8) + "-" + digits.substr(8, 4) + "-" + digits.substr(12, 4) + "-" + digits.substr(16, 4) +
         "-" + digits.substr(20);
}

}  // namespace striae
