#include "tests/support/ptp_photo.h"

#include <algorithm>
#include <utility>

namespace striae::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

void Append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }
void Put16(Bytes& to, std::uint32_t value) {
  to.push_back(static_cast<std::uint8_t>(value >> 8));
  to.push_back(static_cast<std::uint8_t>(value));
}
void Put32(Bytes& to, std::uint32_t value) {
  Put16(to, value >> 16);
  Put16(to, value & 0xFFFF);
}

/// One TIFF directory in the making, big-endian: entries of 12 bytes, longer values behind them.
class Directory {
 public:
  void Short(int tag, int value) {
    Add(tag, 3, 1, Bytes{static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value), 0, 0});
  }
  void Long(int tag, std::vector<std::uint32_t> values) {
    Bytes bytes;
    for (const auto value : values) Put32(bytes, value);
    Add(tag, 4, static_cast<std::uint32_t>(values.size()), bytes);
  }
  void Rational(int tag, std::uint32_t numerator, std::uint32_t denominator) {
    Bytes bytes;
    Put32(bytes, numerator);
    Put32(bytes, denominator);
    Add(tag, 5, 1, bytes);
  }
  void Text(int tag, const std::string& text) {
    Bytes bytes(text.begin(), text.end());
    bytes.push_back(0);
    Add(tag, 2, static_cast<std::uint32_t>(bytes.size()), bytes);
  }
  [[nodiscard]] std::uint32_t Size() const {
    std::size_t size = 2 + 12 * entries_.size() + 4;
    for (const auto& entry : entries_) size += entry.value.size() > 4 ? (entry.value.size() + 1) / 2 * 2 : 0;
    return static_cast<std::uint32_t>(size);
  }
  /// The directory's bytes when it stands at `offset` of its TIFF file.
  [[nodiscard]] Bytes At(std::uint32_t offset) {
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.tag < b.tag; });
    Bytes head, tail;
    Put16(head, static_cast<std::uint32_t>(entries_.size()));
    const auto tail_offset = offset + 2 + 12 * static_cast<std::uint32_t>(entries_.size()) + 4;
    for (const auto& entry : entries_) {
      Put16(head, static_cast<std::uint32_t>(entry.tag));
      Put16(head, static_cast<std::uint32_t>(entry.type));
      Put32(head, entry.count);
      Bytes value = entry.value;
      if (value.size() > 4) {
        Put32(head, tail_offset + static_cast<std::uint32_t>(tail.size()));
        if (value.size() % 2 == 1) value.push_back(0);
        Append(tail, value);
      } else {
        value.resize(4);
        Append(head, value);
      }
    }
    Put32(head, 0);
    Append(head, tail);
    return head;
  }

 private:
  struct Entry {
    int tag, type;
    std::uint32_t count;
    Bytes value;
  };
  void Add(int tag, int type, std::uint32_t count, Bytes value) {
    entries_.push_back({tag, type, count, std::move(value)});
  }
  std::vector<Entry> entries_;
};

Directory CameraTags(const PhotoOptions& options) {
  Directory ifd0;
  ifd0.Text(271, options.make);
  ifd0.Text(272, options.model);
  ifd0.Short(274, options.orientation);
  return ifd0;
}

Bytes TiffHeader() { return {'M', 'M', 0, 42, 0, 0, 0, 8}; }

Bytes ExifTiff(const PhotoOptions& options) {
  Directory ifd0 = CameraTags(options), exif;
  exif.Rational(0x829A, options.exposure_num, options.exposure_den);
  exif.Rational(0x829D, options.f_number_tenths, 10);
  exif.Short(0x8827, options.iso);
  exif.Text(0x9003, options.taken);
  exif.Short(0x9209, options.flash);
  exif.Rational(0x920A, options.focal_length_tenths, 10);
  exif.Text(0x9291, options.sub_second);
  exif.Text(0xA434, options.lens);
  ifd0.Long(0x8769, {0});
  const std::uint32_t exif_offset = 8 + ifd0.Size();
  ifd0 = CameraTags(options);
  ifd0.Long(0x8769, {exif_offset});
  Bytes tiff = TiffHeader();
  Append(tiff, ifd0.At(8));
  Append(tiff, exif.At(exif_offset));
  return tiff;
}

void Segment(Bytes& jpeg, int marker, const Bytes& content) {
  jpeg.push_back(0xFF);
  jpeg.push_back(static_cast<std::uint8_t>(marker));
  Put16(jpeg, static_cast<std::uint32_t>(content.size() + 2));
  Append(jpeg, content);
}

/// A Huffman table with the one code "0" for the symbol 0.
Bytes OneCode(int id) {
  Bytes table(18, 0);
  table[0] = static_cast<std::uint8_t>(id);
  table[1] = 1;  // one code of length 1; the last byte is its symbol
  return table;
}

}  // namespace

Bytes MakeJpeg(const PhotoOptions& options) {
  Bytes jpeg;
  jpeg.reserve(options.padding + 4096);
  Put16(jpeg, 0xFFD8);
  if (options.with_exif) {
    Bytes exif{'E', 'x', 'i', 'f', 0, 0};
    Append(exif, ExifTiff(options));
    Segment(jpeg, 0xE1, exif);
  }
  for (std::size_t left = options.padding; left > 0;) {
    const std::size_t size = std::min<std::size_t>(left, 60000);
    Segment(jpeg, 0xFE, Bytes(size, 'x'));
    left -= size;
  }
  Bytes quantisation(65, 1);
  quantisation[0] = 0;
  Segment(jpeg, 0xDB, quantisation);
  Bytes frame{8};
  Put16(frame, static_cast<std::uint32_t>(options.height));
  Put16(frame, static_cast<std::uint32_t>(options.width));
  Append(frame, {1, 1, 0x11, 0});
  Segment(jpeg, 0xC0, frame);
  Segment(jpeg, 0xC4, OneCode(0x00));
  Segment(jpeg, 0xC4, OneCode(0x10));
  Segment(jpeg, 0xDA, {1, 1, 0x00, 0, 63, 0});
  // Every block is "same mean as before, nothing else": two zero bits.
  const std::size_t blocks =
      static_cast<std::size_t>((options.width + 7) / 8) * static_cast<std::size_t>((options.height + 7) / 8);
  const std::size_t bits = 2 * blocks;
  jpeg.resize(jpeg.size() + bits / 8, 0);
  if (bits % 8 != 0) jpeg.push_back(static_cast<std::uint8_t>(0xFF >> (bits % 8)));
  Put16(jpeg, 0xFFD9);
  return jpeg;
}

Bytes MakeNef(const PhotoOptions& options, std::size_t raw_bytes) {
  PhotoOptions small = options;
  small.with_exif = false;
  small.width = small.height = 16;
  small.padding = 0;
  const Bytes preview = MakeJpeg(small);
  const auto preview_size = static_cast<std::uint32_t>(preview.size());
  const auto image = [](int subfile, int width, int height) {
    Directory directory;
    directory.Long(254, {static_cast<std::uint32_t>(subfile)});
    directory.Long(256, {static_cast<std::uint32_t>(width)});
    directory.Long(257, {static_cast<std::uint32_t>(height)});
    return directory;
  };
  // Two passes: the first with zero offsets gives the sizes.
  std::uint32_t jpeg_at = 0, raw_at = 0, preview_at = 0, strip_at = 0;
  Bytes tiff;
  for (int pass = 0; pass < 2; ++pass) {
    Directory ifd0 = image(1, 160, 120), jpeg = image(1, 570, 375), raw = image(0, options.width, options.height);
    ifd0.Text(271, options.make);
    ifd0.Text(272, options.model);
    ifd0.Short(274, options.orientation);
    ifd0.Long(330, {jpeg_at, raw_at});
    jpeg.Long(513, {preview_at});
    jpeg.Long(514, {preview_size});
    raw.Long(273, {strip_at});
    raw.Long(279, {static_cast<std::uint32_t>(raw_bytes)});
    jpeg_at = 8 + ifd0.Size();
    raw_at = jpeg_at + jpeg.Size();
    preview_at = raw_at + raw.Size();
    strip_at = preview_at + preview_size;
    if (pass == 0) continue;
    tiff = TiffHeader();
    Append(tiff, ifd0.At(8));
    Append(tiff, jpeg.At(jpeg_at));
    Append(tiff, raw.At(raw_at));
    Append(tiff, preview);
    tiff.resize(tiff.size() + raw_bytes, 0x55);
  }
  return tiff;
}

}  // namespace striae::testing
