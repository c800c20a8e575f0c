#include "acquire/detail/jpeg_structure.h"

#include <optional>
#include <string>

#include "acquire/detail/byte_view.h"

namespace striae::acquire::detail {
namespace {

constexpr int kStartOfScan = 0xDA;
constexpr int kEndOfImage = 0xD9;

bool IsFrame(int marker) {  // SOF0..SOF15 without DHT, JPG and DAC, which share the range
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}
bool IsRestart(int marker) { return marker >= 0xD0 && marker <= 0xD7; }
bool StandsAlone(int marker) { return IsRestart(marker) || marker == 0x01 || marker == 0xD8; }

tl::unexpected<Error> Truncated(std::size_t size, const std::string& where) {
  return Fail(ErrorCode::kBadImage, "truncated JPEG: the file ends after " + std::to_string(size) + " bytes " + where +
                                        "; copy it from the card again");
}
tl::unexpected<Error> Contradiction(std::size_t offset, const std::string& what) {
  return Fail(ErrorCode::kBadImage,
              "damaged JPEG: " + what + " at byte " + std::to_string(offset) + "; copy it from the card again");
}

/// Walks marker by marker; the state is what has been seen.
class JpegWalk {
 public:
  explicit JpegWalk(std::span<const std::uint8_t> bytes) : view_(bytes, true) {}

  Result<FileStructure> Run() {
    while (true) {
      auto marker = NextMarker();
      if (!marker) return Fail(marker.error());
      if (*marker == kEndOfImage) return Finish();
      if (StandsAlone(*marker))
        return Contradiction(position_ - 2, "marker " + std::to_string(*marker) + " between segments");
      if (auto done = Segment(*marker); !done) return Fail(done.error());
      if (*marker == kStartOfScan) {
        if (auto done = ScanData(); !done) return Fail(done.error());
      }
    }
  }

 private:
  /// 0xFF, any number of fill bytes 0xFF, code.
  Result<int> NextMarker() {
    const auto first = view_.U8(position_);
    if (!first) return Truncated(view_.size(), "before its end marker");
    if (*first != 0xFF) return Contradiction(position_, "no marker where one must stand");
    while (view_.U8(position_) == 0xFF) ++position_;
    const auto code = view_.U8(position_);
    if (!code) return Truncated(view_.size(), "inside a marker");
    if (*code == 0) return Contradiction(position_, "picture data outside a scan");
    ++position_;
    return *code;
  }

  Status Segment(int marker) {
    const auto length = view_.U16(position_);
    if (!length || !view_.Has(position_, *length)) return Truncated(view_.size(), "inside a header segment");
    if (*length < 2) return Contradiction(position_, "a segment shorter than its own length field");
    if (IsFrame(marker)) {
      if (found_.width_px > 0) return Contradiction(position_, "a second picture frame");
      const auto height = view_.U16(position_ + 3), width = view_.U16(position_ + 5);
      if (*length < 8 || !height || !width || *height == 0 || *width == 0) {
        return Contradiction(position_, "a picture without size");
      }
      found_.height_px = *height;
      found_.width_px = *width;
    }
    if (marker == kStartOfScan && found_.width_px == 0) return Contradiction(position_, "a scan before its frame");
    position_ += *length;
    return {};
  }

  /// Entropy-coded data up to the next marker that is neither stuffing (FF 00) nor a restart.
  Status ScanData() {
    const std::size_t start = position_;
    const auto bytes = view_.bytes();
    while (position_ + 1 < bytes.size()) {
      if (bytes[position_] != 0xFF) {
        ++position_;
        continue;
      }
      const int code = bytes[position_ + 1];
      if (code != 0 && code != 0xFF && !IsRestart(code)) break;
      position_ += code == 0xFF ? 1 : 2;
    }
    if (position_ + 1 >= bytes.size()) return Truncated(view_.size(), "inside the picture data");
    if (position_ == start) return Contradiction(position_, "a scan without picture data");
    has_scan_ = true;
    return {};
  }

  Result<FileStructure> Finish() {
    if (!has_scan_) return Contradiction(position_ - 2, "the end marker before any picture data");
    found_.media_type = "image/jpeg";
    found_.image_bytes = position_;
    found_.trailing_bytes = view_.size() - position_;
    return found_;
  }

  ByteView view_;
  std::size_t position_ = 2;  // after SOI
  bool has_scan_ = false;
  FileStructure found_;
};

}  // namespace

Result<FileStructure> CheckJpeg(std::span<const std::uint8_t> bytes) { return JpegWalk(bytes).Run(); }

}  // namespace striae::acquire::detail
