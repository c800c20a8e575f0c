#include "acquire/detail/nef_structure.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "acquire/detail/byte_view.h"

namespace striae::acquire::detail {
namespace {

// TIFF tags (TIFF 6.0; SubIFDs: TIFF Technical Note 1).
constexpr int kNewSubfileType = 254, kWidth = 256, kHeight = 257, kMake = 271, kStripOffsets = 273, kStripCounts = 279,
              kSubIfds = 330, kJpegOffset = 513, kJpegLength = 514;
constexpr std::size_t kMaxDirectories = 32;  // a D90 has 4; a loop of directories must end
constexpr std::size_t kMaxValues = 65536;    // strips of one image

struct Directory {
  std::uint32_t subfile_type = 0;
  std::uint32_t width = 0, height = 0;
  std::string make;
  std::vector<std::uint32_t> strip_offsets, strip_counts, sub_ifds, jpeg_offset, jpeg_length;
};

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage, "damaged or truncated NEF: " + what + "; copy it from the card again");
}

std::size_t SizeOfType(int type) {
  switch (type) {
    case 1:
    case 2:
    case 6:
    case 7:
      return 1;
    case 3:
    case 8:
      return 2;
    case 4:
    case 9:
    case 11:
    case 13:
      return 4;
    case 5:
    case 10:
    case 12:
      return 8;
    default:
      return 0;
  }
}

class NefWalk {
 public:
  explicit NefWalk(std::span<const std::uint8_t> bytes) : view_(bytes, bytes[0] == 'M') {}

  Result<FileStructure> Run() {
    std::vector<std::uint32_t> waiting;
    if (const auto first = view_.U32(4); first && *first != 0) waiting.push_back(*first);
    std::vector<std::uint32_t> seen;
    while (!waiting.empty()) {
      const std::uint32_t offset = waiting.back();
      waiting.pop_back();
      if (std::find(seen.begin(), seen.end(), offset) != seen.end()) return Bad("its directories form a loop");
      if (seen.size() >= kMaxDirectories) return Bad("it has too many directories");
      seen.push_back(offset);
      if (auto done = Visit(offset, waiting); !done) return Fail(done.error());
    }
    if (make_.rfind("NIKON", 0) != 0) {
      return Fail(ErrorCode::kBadImage, "this TIFF file was not made by a Nikon camera; import JPEG or NEF files");
    }
    if (found_.width_px == 0) return Bad("it holds no picture");
    found_.media_type = "image/x-nikon-nef";
    found_.trailing_bytes = view_.size() - found_.image_bytes;
    return found_;
  }

 private:
  Status Visit(std::uint32_t offset, std::vector<std::uint32_t>& waiting) {
    const auto count = view_.U16(offset);
    if (!count || !view_.Has(offset, 2 + 12ULL * *count + 4)) return Bad("a directory lies outside the file");
    Directory directory;
    for (std::uint64_t entry = 0; entry < *count; ++entry) {
      if (!Entry(offset + 2 + 12 * entry, directory)) return Bad("a value lies outside the file");
    }
    Reach(offset + 2 + 12ULL * *count + 4);
    if (!InFile(directory.strip_offsets, directory.strip_counts)) return Bad("picture data are missing at the end");
    if (!InFile(directory.jpeg_offset, directory.jpeg_length)) return Bad("a preview is missing at the end");
    if (make_.empty()) make_ = directory.make;
    const bool main_image = directory.subfile_type == 0 && !directory.strip_offsets.empty();
    if (main_image && directory.width > 0 && directory.height > 0 && directory.width <= 65535 &&
        directory.height <= 65535) {
      found_.width_px = static_cast<int>(directory.width);
      found_.height_px = static_cast<int>(directory.height);
    }
    waiting.insert(waiting.end(), directory.sub_ifds.begin(), directory.sub_ifds.end());
    const auto next = view_.U32(offset + 2 + 12ULL * *count);
    if (next && *next != 0) waiting.push_back(*next);
    return {};
  }

  /// False when the entry's value lies outside the file.
  bool Entry(std::uint64_t at, Directory& directory) {
    const int tag = *view_.U16(at), type = *view_.U16(at + 2);
    const std::uint32_t count = *view_.U32(at + 4);
    const std::uint64_t bytes = static_cast<std::uint64_t>(count) * SizeOfType(type);
    const std::uint64_t value = bytes <= 4 ? at + 8 : *view_.U32(at + 8);
    if (!view_.Has(value, bytes)) return false;
    Reach(value + bytes);
    if (tag == kMake && type == 2) {
      const auto text = view_.bytes().subspan(value, bytes);
      directory.make.assign(text.begin(), text.end());
      return true;
    }
    if ((type != 3 && type != 4 && type != 13) || count == 0 || count > kMaxValues) return true;
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      numbers[i] = type == 3 ? *view_.U16(value + 2ULL * i) : *view_.U32(value + 4ULL * i);
    }
    Keep(tag, std::move(numbers), directory);
    return true;
  }

  static void Keep(int tag, std::vector<std::uint32_t> numbers, Directory& directory) {
    switch (tag) {
      case kNewSubfileType:
        directory.subfile_type = numbers[0];
        break;
      case kWidth:
        directory.width = numbers[0];
        break;
      case kHeight:
        directory.height = numbers[0];
        break;
      case kStripOffsets:
        directory.strip_offsets = std::move(numbers);
        break;
      case kStripCounts:
        directory.strip_counts = std::move(numbers);
        break;
      case kSubIfds:
        directory.sub_ifds = std::move(numbers);
        break;
      case kJpegOffset:
        directory.jpeg_offset = std::move(numbers);
        break;
      case kJpegLength:
        directory.jpeg_length = std::move(numbers);
        break;
      default:
        break;
    }
  }

  bool InFile(const std::vector<std::uint32_t>& offsets, const std::vector<std::uint32_t>& counts) {
    if (offsets.size() != counts.size()) return false;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (!view_.Has(offsets[i], counts[i])) return false;
      Reach(static_cast<std::uint64_t>(offsets[i]) + counts[i]);
    }
    return true;
  }

  void Reach(std::uint64_t end) { found_.image_bytes = std::max(found_.image_bytes, static_cast<std::size_t>(end)); }

  ByteView view_;
  std::string make_;
  FileStructure found_;
};

}  // namespace

Result<FileStructure> CheckNef(std::span<const std::uint8_t> bytes) { return NefWalk(bytes).Run(); }

}  // namespace striae::acquire::detail
