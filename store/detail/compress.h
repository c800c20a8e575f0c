// Zstandard (RFC 8878) frames of whole files.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace striae::store::detail {

std::vector<std::uint8_t> Compress(std::span<const std::uint8_t> bytes);
/// `size` is the length before compression. Throws Failed (kRecordDamaged) when the frame does not give it.
std::vector<std::uint8_t> Decompress(std::span<const std::uint8_t> frame, std::uint64_t size);

}  // namespace striae::store::detail
