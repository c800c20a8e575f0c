#include "acquire/structure.h"

#include <algorithm>
#include <array>

#include "acquire/detail/jpeg_structure.h"
#include "acquire/detail/nef_structure.h"

namespace striae::acquire {
namespace {

bool StartsWith(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> head) {
  return bytes.size() >= head.size() && std::equal(head.begin(), head.end(), bytes.begin());
}

}  // namespace

Result<FileStructure> CheckStructure(std::span<const std::uint8_t> bytes) {
  static constexpr std::array<std::uint8_t, 2> kJpeg{0xFF, 0xD8};
  static constexpr std::array<std::uint8_t, 4> kTiffLittle{'I', 'I', 42, 0};
  static constexpr std::array<std::uint8_t, 4> kTiffBig{'M', 'M', 0, 42};
  if (bytes.empty()) {
    return Fail(ErrorCode::kBadImage, "the file is empty (0 bytes); copy it from the card again");
  }
  if (StartsWith(bytes, kJpeg)) return detail::CheckJpeg(bytes);
  if (StartsWith(bytes, kTiffLittle) || StartsWith(bytes, kTiffBig)) return detail::CheckNef(bytes);
  return Fail(ErrorCode::kBadImage,
              "this is neither a JPEG nor a Nikon NEF file (its first bytes say so); import the camera's own files");
}

}  // namespace striae::acquire
