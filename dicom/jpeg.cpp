#include "dicom/jpeg.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace striae::dicom {
namespace {

constexpr std::uint8_t kSof0 = 0xC0, kDht = 0xC4, kJpg = 0xC8, kDac = 0xCC, kSof15 = 0xCF;
constexpr std::uint8_t kRst0 = 0xD0, kRst7 = 0xD7, kSoi = 0xD8, kEoi = 0xD9, kSos = 0xDA;
constexpr std::uint8_t kApp0 = 0xE0, kApp14 = 0xEE, kApp15 = 0xEF, kCom = 0xFE, kTem = 0x01;

using Bytes = std::span<const std::uint8_t>;

/// One marker with all that belongs to it: for SOS also the entropy-coded data that follow.
struct Segment {
  std::uint8_t marker = 0;
  Bytes all;      ///< from 0xFF on
  Bytes payload;  ///< after the two length bytes; empty for markers without a length
};

bool StandsAlone(std::uint8_t marker) {
  return marker == kTem || marker == kSoi || marker == kEoi || (marker >= kRst0 && marker <= kRst7);
}

/// First position at or after `at` where a marker other than RSTn begins in entropy-coded data.
std::size_t EndOfScan(Bytes jpeg, std::size_t at) {
  for (; at + 1 < jpeg.size(); ++at) {
    if (jpeg[at] != 0xFF) continue;
    const std::uint8_t next = jpeg[at + 1];
    if (next != 0 && next != 0xFF && (next < kRst0 || next > kRst7)) return at;
  }
  return jpeg.size();
}

Result<std::vector<Segment>> Split(Bytes jpeg) {
  if (jpeg.size() < 4 || jpeg[0] != 0xFF || jpeg[1] != kSoi) {
    return Fail(ErrorCode::kBadImage, "not a JPEG file; DICOM export needs the camera's JPEG");
  }
  const auto truncated = [] {
    return Fail(ErrorCode::kBadImage, "the JPEG ends early; copy it from the camera again");
  };
  std::vector<Segment> segments;
  std::size_t at = 0;
  while (true) {
    while (at + 1 < jpeg.size() && jpeg[at] == 0xFF && jpeg[at + 1] == 0xFF) ++at;  // fill bytes
    if (at + 2 > jpeg.size()) return truncated();
    if (jpeg[at] != 0xFF) return Fail(ErrorCode::kBadImage, "the JPEG is damaged: a marker is missing");
    Segment segment;
    segment.marker = jpeg[at + 1];
    std::size_t end = at + 2;
    if (!StandsAlone(segment.marker)) {
      if (at + 4 > jpeg.size()) return truncated();
      const std::size_t length = 256U * jpeg[at + 2] + jpeg[at + 3];
      if (length < 2) return Fail(ErrorCode::kBadImage, "the JPEG is damaged: a segment has no length");
      end = at + 2 + length;
      if (end > jpeg.size()) return truncated();
      segment.payload = jpeg.subspan(at + 4, length - 2);
      if (segment.marker == kSos) end = EndOfScan(jpeg, end);
    }
    segment.all = jpeg.subspan(at, end - at);
    segments.push_back(segment);
    if (segment.marker == kEoi) return segments;
    at = end;
  }
}

bool IsFrameHeader(std::uint8_t marker) {
  return marker >= kSof0 && marker <= kSof15 && marker != kDht && marker != kJpg && marker != kDac;
}

bool BeginsWith(Bytes payload, std::string_view text) {
  return payload.size() >= text.size() && std::equal(text.begin(), text.end(), payload.begin(),
                                                     [](char a, std::uint8_t b) { return a == static_cast<char>(b); });
}

/// The colour transform that APP14 Adobe states: 0 = components are R, G, B.
std::optional<int> AdobeTransform(const std::vector<Segment>& segments) {
  for (const Segment& segment : segments) {
    if (segment.marker == kApp14 && BeginsWith(segment.payload, "Adobe") && segment.payload.size() >= 12) {
      return segment.payload[11];
    }
  }
  return std::nullopt;
}

bool HasJfif(const std::vector<Segment>& segments) {
  return std::any_of(segments.begin(), segments.end(),
                     [](const Segment& s) { return s.marker == kApp0 && BeginsWith(s.payload, "JFIF"); });
}

/// As libjpeg decides: JFIF is YCbCr; Adobe says it; else component ids "R", "G", "B" are RGB.
bool IsRgb(const std::vector<Segment>& segments, Bytes frame) {
  if (HasJfif(segments)) return false;
  if (const auto transform = AdobeTransform(segments)) return *transform == 0;
  return frame[6] == 'R' && frame[9] == 'G' && frame[12] == 'B';
}

}  // namespace

Result<JpegInfo> InspectJpeg(Bytes jpeg) {
  const auto segments = Split(jpeg);
  if (!segments) return Fail(segments.error());
  const auto frame = std::find_if(segments->begin(), segments->end(),
                                  [](const Segment& segment) { return IsFrameHeader(segment.marker); });
  if (frame == segments->end()) return Fail(ErrorCode::kBadImage, "the JPEG has no frame header");
  const Bytes header = frame->payload;
  if (frame->marker != kSof0 || header.size() < 6 || header[0] != 8) {
    return Fail(ErrorCode::kBadImage,
                "only an 8-bit baseline JPEG can go into DICOM unchanged; this one is progressive, lossless or 12-bit");
  }
  JpegInfo info;
  info.height_px = 256 * header[1] + header[2];
  info.width_px = 256 * header[3] + header[4];
  const std::size_t components = header[5];
  if (info.width_px == 0 || info.height_px == 0) return Fail(ErrorCode::kBadImage, "the JPEG does not say its size");
  if ((components != 1 && components != 3) || header.size() < 6 + 3 * components) {
    return Fail(ErrorCode::kBadImage, "the JPEG is neither grey nor a three-component colour picture");
  }
  if (std::none_of(segments->begin(), segments->end(), [](const Segment& s) { return s.marker == kSos; })) {
    return Fail(ErrorCode::kBadImage, "the JPEG has no image data");
  }
  if (components == 3 && IsRgb(*segments, header)) {
    return Fail(ErrorCode::kBadImage, "the JPEG holds RGB without a colour transform, which DICOM does not take");
  }
  info.colour = components == 1 ? JpegInfo::Colour::kGrey : JpegInfo::Colour::kYcc;
  return info;
}

Result<std::vector<std::uint8_t>> StripJpegMetadata(Bytes jpeg) {
  const auto segments = Split(jpeg);
  if (!segments) return Fail(segments.error());
  std::vector<std::uint8_t> out;
  out.reserve(jpeg.size());
  for (const Segment& segment : *segments) {
    const bool application = segment.marker >= kApp0 && segment.marker <= kApp15;
    const bool colour = (segment.marker == kApp0 && BeginsWith(segment.payload, "JFIF")) ||
                        (segment.marker == kApp14 && BeginsWith(segment.payload, "Adobe"));
    if ((application && !colour) || segment.marker == kCom) continue;
    out.insert(out.end(), segment.all.begin(), segment.all.end());
  }
  return out;
}

}  // namespace striae::dicom
