#include "tests/support/dng.h"

#include <algorithm>

namespace striae::testing {
namespace {

enum Type : std::uint16_t { kByte = 1, kAscii = 2, kShort = 3, kLong = 4, kRational = 5, kSignedRational = 10 };

struct Entry {
  std::uint16_t tag;
  Type type;
  std::uint32_t count;
  std::vector<std::uint8_t> data;
};

template <typename T>
void Put(std::vector<std::uint8_t>& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

template <typename T>
Entry Numbers(std::uint16_t tag, Type type, const std::vector<T>& values) {
  Entry entry{tag, type, static_cast<std::uint32_t>(values.size()), {}};
  for (const T value : values) Put(entry.data, value);
  if (type == kRational || type == kSignedRational) entry.count /= 2;
  return entry;
}
Entry Short(std::uint16_t tag, std::uint16_t value) { return Numbers<std::uint16_t>(tag, kShort, {value}); }
Entry Long(std::uint16_t tag, std::uint32_t value) { return Numbers<std::uint32_t>(tag, kLong, {value}); }
Entry Text(std::uint16_t tag, const std::string& text) {
  Entry entry{tag, kAscii, static_cast<std::uint32_t>(text.size() + 1), {text.begin(), text.end()}};
  entry.data.push_back(0);
  return entry;
}

/// Directory and its values, written at the end of `bytes`.
void PutDirectory(std::vector<std::uint8_t>& bytes, std::vector<Entry> entries) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.tag < b.tag; });
  std::size_t values = bytes.size() + 2 + 12 * entries.size() + 4;
  std::vector<std::uint8_t> after;
  Put(bytes, static_cast<std::uint16_t>(entries.size()));
  for (const Entry& entry : entries) {
    Put(bytes, entry.tag);
    Put(bytes, static_cast<std::uint16_t>(entry.type));
    Put(bytes, entry.count);
    if (entry.data.size() <= 4) {
      for (std::size_t i = 0; i < 4; ++i) bytes.push_back(i < entry.data.size() ? entry.data[i] : 0);
      continue;
    }
    Put(bytes, static_cast<std::uint32_t>(values + after.size()));
    after.insert(after.end(), entry.data.begin(), entry.data.end());
    if (after.size() % 2 != 0) after.push_back(0);
  }
  Put(bytes, std::uint32_t{0});
  bytes.insert(bytes.end(), after.begin(), after.end());
}

}  // namespace

std::vector<std::uint8_t> MakeDng(const DngOptions& options, const std::function<std::uint16_t(int, int, int)>& value) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(1024 + options.preview_jpeg.size());  // g++ 12 sees a copy out of bounds in a vector that grows from 8
  for (const std::uint8_t byte : {'I', 'I', '*', '\0', '\0', '\0', '\0', '\0'}) bytes.push_back(byte);
  const auto preview_at = static_cast<std::uint32_t>(bytes.size());
  bytes.insert(bytes.end(), options.preview_jpeg.begin(), options.preview_jpeg.end());
  if (bytes.size() % 2 != 0) bytes.push_back(0);
  const auto raw_at = static_cast<std::uint32_t>(bytes.size());
  for (int row = 0; row < options.height; ++row) {
    for (int col = 0; col < options.width; ++col) Put(bytes, value(col, row, col % 2 + row % 2));
  }
  const auto raw_bytes = static_cast<std::uint32_t>(bytes.size()) - raw_at;
  const auto width = static_cast<std::uint32_t>(options.width), height = static_cast<std::uint32_t>(options.height);
  const std::vector<Entry> raw = {Long(254, 0),
                                  Long(256, width),
                                  Long(257, height),
                                  Short(258, 16),
                                  Short(259, 1),
                                  Short(262, 32803),
                                  Long(273, raw_at),
                                  Short(277, 1),
                                  Long(278, height),
                                  Long(279, raw_bytes),
                                  Short(284, 1),
                                  Numbers<std::uint16_t>(33421, kShort, {2, 2}),
                                  Numbers<std::uint8_t>(33422, kByte, {0, 1, 1, 2}),
                                  Short(50714, 0),
                                  Short(50717, options.white)};
  // XYZ (D65) to camera: sRGB's own matrix, so that the camera's colours are sRGB's.
  const std::vector<std::uint32_t> matrix = {32406,
                                             10000,
                                             static_cast<std::uint32_t>(-15372),
                                             10000,
                                             static_cast<std::uint32_t>(-4986),
                                             10000,
                                             static_cast<std::uint32_t>(-9689),
                                             10000,
                                             18758,
                                             10000,
                                             415,
                                             10000,
                                             557,
                                             10000,
                                             static_cast<std::uint32_t>(-2040),
                                             10000,
                                             10570,
                                             10000};
  std::vector<Entry> first = {Text(271, options.make),
                              Text(272, options.model),
                              Short(274, 6),
                              Text(50708, options.make + " " + options.model),
                              Numbers<std::uint8_t>(50706, kByte, {1, 4, 0, 0}),
                              Numbers<std::uint32_t>(50721, kSignedRational, matrix),
                              Short(50778, 21),
                              Numbers<std::uint32_t>(50728, kRational, {1, 1, 1, 1, 1, 1})};
  const auto sub_at = static_cast<std::uint32_t>(bytes.size());
  if (options.preview_jpeg.empty()) {
    first.insert(first.end(), raw.begin(), raw.end());
  } else {
    PutDirectory(bytes, raw);
    const std::vector<Entry> preview = {Long(254, 1),
                                        Long(256, static_cast<std::uint32_t>(options.preview_width)),
                                        Long(257, static_cast<std::uint32_t>(options.preview_height)),
                                        Numbers<std::uint16_t>(258, kShort, {8, 8, 8}),
                                        Short(259, 7),
                                        Short(262, 6),
                                        Long(273, preview_at),
                                        Short(277, 3),
                                        Long(278, static_cast<std::uint32_t>(options.preview_height)),
                                        Long(279, static_cast<std::uint32_t>(options.preview_jpeg.size())),
                                        Long(330, sub_at)};
    first.insert(first.end(), preview.begin(), preview.end());
  }
  const auto first_at = static_cast<std::uint32_t>(bytes.size());
  PutDirectory(bytes, first);
  for (int i = 0; i < 4; ++i) bytes[static_cast<std::size_t>(4 + i)] = static_cast<std::uint8_t>(first_at >> (8 * i));
  return bytes;
}

}  // namespace striae::testing
