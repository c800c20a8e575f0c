// Bytes as lower-case hexadecimal digits, and the SHA-256 digest type.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

namespace striae {

std::string ToHex(std::span<const std::uint8_t> bytes);
/// False when `text` has not exactly two hexadecimal digits for every byte.
bool FromHex(std::string_view text, std::span<std::uint8_t> bytes);

/// What identifies a file's content everywhere: 32 bytes, printed as 64 lower-case hexadecimal digits.
struct Sha256 {
  std::array<std::uint8_t, 32> bytes{};
  static Result<Sha256> Parse(std::string_view text);
  [[nodiscard]] std::string ToString() const { return ToHex(bytes); }
  auto operator<=>(const Sha256&) const = default;
};

}  // namespace striae
