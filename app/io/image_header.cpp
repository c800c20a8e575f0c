#include "app/io/image_header.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace striae::app {
namespace {

using Bytes = std::span<const std::uint8_t>;

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage, what + "; take the file from the camera's card again");
}

/// `count` bytes at `at` as an unsigned number; nullopt beyond the end.
std::optional<std::uint32_t> Number(Bytes bytes, std::size_t at, std::size_t count, bool big_endian) {
  if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t shift = 8 * (big_endian ? count - 1 - i : i);
    value |= std::uint32_t{bytes[at + i]} << shift;
  }
  return value;
}

bool StartsWith(Bytes bytes, std::initializer_list<int> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

Result<ImageHeader> JpegHeader(Bytes bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != 0xff) break;
    const int marker = bytes[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) {
      const auto height = Number(bytes, at + 5, 2, true), width = Number(bytes, at + 7, 2, true);
      if (!height || !width) break;
      return ImageHeader{ImageKind::kJpeg, *width, *height};
    }
    if (marker == 0xda || marker == 0xd9) break;
    at += 2 + *Number(bytes, at + 2, 2, true);
  }
  return Bad("the JPEG is truncated or damaged (no frame header)");
}

/// Of one directory of a TIFF: what decides how the file is read.
struct TiffDirectory {
  std::int64_t width = 0, height = 0;
  bool filter_array = false;
  std::vector<std::size_t> others;  ///< offsets of further directories
};

std::optional<TiffDirectory> ReadDirectory(Bytes bytes, std::size_t at, bool big) {
  const auto count = Number(bytes, at, 2, big);
  if (!count) return std::nullopt;
  TiffDirectory directory;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const std::size_t entry = at + 2 + 12 * std::size_t{i};
    const auto tag = Number(bytes, entry, 2, big), type = Number(bytes, entry + 2, 2, big),
               number = Number(bytes, entry + 4, 4, big);
    const auto value = Number(bytes, entry + 8, type == 3U ? 2 : 4, big);
    if (!tag || !type || !number || !value) return std::nullopt;
    constexpr std::uint32_t kWidth = 256, kHeight = 257, kPhotometric = 262, kSubDirectories = 330,
                            kFilterArray = 32803;
    if (*tag == kWidth) directory.width = *value;
    if (*tag == kHeight) directory.height = *value;
    if (*tag == kPhotometric) directory.filter_array = *value == kFilterArray;
    if (*tag != kSubDirectories) continue;
    if (*number == 1) directory.others.push_back(*value);
    for (std::uint32_t k = 0; *number > 1 && k < std::min(*number, 8U); ++k) {
      if (const auto offset = Number(bytes, *value + 4 * std::size_t{k}, 4, big)) directory.others.push_back(*offset);
    }
  }
  if (const auto next = Number(bytes, at + 2 + 12 * std::size_t{*count}, 4, big); next.value_or(0) != 0) {
    directory.others.push_back(*next);
  }
  return directory;
}

Result<ImageHeader> TiffHeader(Bytes bytes) {
  constexpr std::size_t kMostDirectories = 16;  // a chain may run in a circle
  const bool big = bytes[0] == 'M';
  const auto first = Number(bytes, 4, 4, big);
  std::optional<ImageHeader> found;
  std::vector<std::size_t> open;
  if (first) open.push_back(*first);
  for (std::size_t i = 0; i < open.size() && i < kMostDirectories; ++i) {
    const auto directory = ReadDirectory(bytes, open[i], big);
    if (!directory) continue;
    if (directory->filter_array) return ImageHeader{ImageKind::kRaw, directory->width, directory->height};
    if (i == 0) found = ImageHeader{ImageKind::kTiff, directory->width, directory->height};
    open.insert(open.end(), directory->others.begin(), directory->others.end());
  }
  if (!found) return Bad("the TIFF is truncated or damaged (no directory)");
  return *found;
}

Result<ImageHeader> PngHeader(Bytes bytes) {
  const auto width = Number(bytes, 16, 4, true), height = Number(bytes, 20, 4, true);
  if (!width || !height) return Bad("the PNG is truncated");
  return ImageHeader{ImageKind::kPng, *width, *height};
}

Result<ImageHeader> BmpHeader(Bytes bytes) {
  const auto width = Number(bytes, 18, 4, false), height = Number(bytes, 22, 4, false);
  if (!width || !height) return Bad("the BMP is truncated");
  // A negative height means rows from the top.
  return ImageHeader{ImageKind::kBmp, static_cast<std::int32_t>(*width),
                     std::abs(std::int64_t{static_cast<std::int32_t>(*height)})};
}

Result<ImageHeader> AnyHeader(Bytes bytes) {
  if (bytes.empty()) return Bad("the file is empty");
  if (StartsWith(bytes, {0xff, 0xd8, 0xff})) return JpegHeader(bytes);
  if (StartsWith(bytes, {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a})) return PngHeader(bytes);
  if (StartsWith(bytes, {'I', 'I', 42, 0}) || StartsWith(bytes, {'M', 'M', 0, 42})) return TiffHeader(bytes);
  if (StartsWith(bytes, {'B', 'M'})) return BmpHeader(bytes);
  return Bad("this is no JPEG, PNG, TIFF, BMP or raw (NEF, DNG) photograph");
}

}  // namespace

Result<ImageHeader> ReadImageHeader(Bytes bytes) {
  const auto header = AnyHeader(bytes);
  if (!header) return Fail(header.error());
  if (header->width <= 0 || header->height <= 0) return Bad("the image says that it has no pixels");
  if (header->width > kMostPixels / header->height) {
    return Fail(ErrorCode::kBadImage, "the image has " + std::to_string(header->width) + " x " +
                                          std::to_string(header->height) +
                                          " pixels, more than 100 megapixels are not read; use the camera's original");
  }
  return *header;
}

}  // namespace striae::app
