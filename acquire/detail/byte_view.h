// Numbers out of untrusted bytes: every bound and overflow is checked in this one place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace striae::acquire::detail {

class ByteView {
 public:
  ByteView(std::span<const std::uint8_t> bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  /// True when [offset, offset + count) lies inside.
  [[nodiscard]] bool Has(std::uint64_t offset, std::uint64_t count) const {
    return count <= bytes_.size() && offset <= bytes_.size() - count;
  }
  [[nodiscard]] std::optional<std::uint8_t> U8(std::uint64_t offset) const {
    if (!Has(offset, 1)) return std::nullopt;
    return bytes_[offset];
  }
  [[nodiscard]] std::optional<std::uint16_t> U16(std::uint64_t offset) const {
    if (!Has(offset, 2)) return std::nullopt;
    const unsigned first = bytes_[offset], second = bytes_[offset + 1];
    return static_cast<std::uint16_t>(big_endian_ ? (first << 8) | second : (second << 8) | first);
  }
  [[nodiscard]] std::optional<std::uint32_t> U32(std::uint64_t offset) const {
    if (!Has(offset, 4)) return std::nullopt;
    const std::uint32_t first = *U16(offset), second = *U16(offset + 2);
    return big_endian_ ? (first << 16) | second : (second << 16) | first;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  bool big_endian_;
};

}  // namespace striae::acquire::detail
