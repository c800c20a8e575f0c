// What the tether worker says to its parent: frames of a tag, a JSON header and bytes, over a pipe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace striae::acquire::detail {

/// "phase" {"name"}, "beat" {}, "file" {"folder","name","ours"} + the file, "fail" {"kind","code","text"}, "done" {}.
struct Frame {            // NOLINT(bugprone-exception-escape): nlohmann's own noexcept move
  nlohmann::json header;  ///< always has "tag"
  std::vector<std::uint8_t> bytes;
};

constexpr int kFrameDescriptor = 3;  ///< the worker's end of the pipe; stdout stays free of libraries' chatter

/// Header length, byte count (both u32 little-endian), header, bytes. False when the reader is gone.
bool WriteFrame(int descriptor, const Frame& frame);

/// Collects what arrives and cuts it into frames.
class FrameParser {
 public:
  void Append(const std::uint8_t* bytes, std::size_t size);
  /// The next whole frame; nullopt when more must arrive. Sets broken() on nonsense.
  std::optional<Frame> Next();
  [[nodiscard]] bool broken() const { return broken_; }

 private:
  std::vector<std::uint8_t> buffer_;
  bool broken_ = false;
};

}  // namespace striae::acquire::detail
