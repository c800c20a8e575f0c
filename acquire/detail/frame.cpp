#include "acquire/detail/frame.h"

#include <cerrno>

#include <unistd.h>

namespace striae::acquire::detail {
namespace {

constexpr std::size_t kPrefix = 8;
constexpr std::uint32_t kLongestHeader = 1U << 16, kLongestFile = 1U << 29;

void PutU32(std::vector<std::uint8_t>& to, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) to.push_back(static_cast<std::uint8_t>(value >> shift));
}
std::uint32_t GetU32(const std::vector<std::uint8_t>& from, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(from[at + i]) << (8 * i);
  return value;
}

bool WriteAll(int descriptor, const std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

bool WriteFrame(int descriptor, const Frame& frame) {
  // Names on a card need not be UTF-8; a replacement character is better than no frame.
  const std::string header = frame.header.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::vector<std::uint8_t> start;
  PutU32(start, header.size());
  PutU32(start, frame.bytes.size());
  start.insert(start.end(), header.begin(), header.end());
  return WriteAll(descriptor, start.data(), start.size()) &&
         WriteAll(descriptor, frame.bytes.data(), frame.bytes.size());
}

void FrameParser::Append(const std::uint8_t* bytes, std::size_t size) {
  buffer_.insert(buffer_.end(), bytes, bytes + size);
}

std::optional<Frame> FrameParser::Next() {
  if (broken_ || buffer_.size() < kPrefix) return std::nullopt;
  const std::uint32_t header_size = GetU32(buffer_, 0), file_size = GetU32(buffer_, 4);
  broken_ = header_size > kLongestHeader || file_size > kLongestFile;
  const std::size_t whole = kPrefix + header_size + static_cast<std::size_t>(file_size);
  if (broken_ || buffer_.size() < whole) return std::nullopt;
  const auto header = buffer_.begin() + kPrefix;
  const auto file = header + static_cast<std::ptrdiff_t>(header_size);
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(whole);
  Frame frame;
  frame.header = nlohmann::json::parse(header, file, nullptr, false);
  frame.bytes.assign(file, end);
  buffer_.erase(buffer_.begin(), end);
  broken_ = !frame.header.is_object() || !frame.header.contains("tag") || !frame.header["tag"].is_string();
  if (broken_) return std::nullopt;
  return frame;
}

}  // namespace striae::acquire::detail
