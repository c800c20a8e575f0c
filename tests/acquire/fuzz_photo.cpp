// A fuzzer's entry for everything that reads a photograph's bytes before they are trusted. With clang:
// -fsanitize=fuzzer,address on this file and the library; fuzz_test.cpp replays a made corpus through it.
#include "tests/acquire/fuzz_photo.h"

#include <cstdlib>
#include <span>

#include "acquire/metadata.h"
#include "acquire/structure.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using striae::acquire::CheckStructure;
  using striae::acquire::ReadMetadata;
  const std::span<const std::uint8_t> bytes(data, size);
  const auto structure = CheckStructure(bytes);
  const auto metadata = ReadMetadata(bytes);
  bool good = structure.has_value() == metadata.has_value();
  if (structure) {
    good = good && structure->image_bytes + structure->trailing_bytes <= size && structure->width_px > 0 &&
           structure->height_px > 0 && metadata->width_px == structure->width_px;
  } else {
    good = good && structure.error().code == striae::ErrorCode::kBadImage && !structure.error().message.empty();
  }
  if (!good) std::abort();
  return 0;
}
