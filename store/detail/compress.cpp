#include "store/detail/compress.h"

#include <zstd.h>

#include "store/detail/failed.h"

namespace striae::store::detail {

std::vector<std::uint8_t> Compress(std::span<const std::uint8_t> bytes) {
  constexpr int kLevel = 1;  // coordinates hardly gain from more, and a surface has hundreds of megabytes
  std::vector<std::uint8_t> frame(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0) Refuse(ErrorCode::kInternal, std::string("zstd: ") + ZSTD_getErrorName(size));
  frame.resize(size);
  return frame;
}

std::vector<std::uint8_t> Decompress(std::span<const std::uint8_t> frame, std::uint64_t size) {
  if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != size) {
    Refuse(ErrorCode::kRecordDamaged, "a derived file is not as long as the record says; run 'striae check'");
  }
  std::vector<std::uint8_t> bytes(size);
  const std::size_t got = ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size());
  if (ZSTD_isError(got) != 0 || got != size) {
    Refuse(ErrorCode::kRecordDamaged, "a derived file cannot be decompressed; run 'striae check'");
  }
  return bytes;
}

}  // namespace striae::store::detail
