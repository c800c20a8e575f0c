#include "acquire/metadata.h"

#include <cmath>
#include <exception>
#include <string>

#include <exiv2/exiv2.hpp>

#include "acquire/structure.h"

namespace striae::acquire {
namespace {

std::string Trimmed(std::string text) {
  const char* blank = " \t\r\n";
  text.erase(text.find_last_not_of(std::string(blank) + '\0') + 1);
  text.erase(0, text.find_first_not_of(blank));
  // Control characters have no place in a record or a report.
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) text.resize(kLongest);
  return text;
}

/// Tags by name; whatever is wrong with one reads as absent.
class Tags {
 public:
  explicit Tags(const Exiv2::ExifData& data) : data_(data) {}

  [[nodiscard]] const Exiv2::Exifdatum* Find(const char* key) const {
    const auto found = data_.findKey(Exiv2::ExifKey(key));
    return found == data_.end() || found->count() == 0 ? nullptr : &*found;
  }
  [[nodiscard]] std::string Text(const char* key) const {
    const auto* tag = Find(key);
    return tag == nullptr ? "" : Trimmed(tag->toString());
  }
  [[nodiscard]] std::string Printed(const char* key) const {
    const auto* tag = Find(key);
    return tag == nullptr ? "" : Trimmed(tag->print(&data_));
  }
  [[nodiscard]] std::optional<long> Number(const char* key, long index = 0) const {
    const auto* tag = Find(key);
    if (tag == nullptr || tag->count() <= index) return std::nullopt;
    const long value = tag->toLong(index);
    return tag->value().ok() ? std::optional(value) : std::nullopt;
  }
  /// A rational that is finite and positive.
  [[nodiscard]] std::optional<double> Positive(const char* key) const {
    const auto* tag = Find(key);
    if (tag == nullptr) return std::nullopt;
    const Exiv2::Rational value = tag->toRational();
    if (!tag->value().ok() || value.second == 0) return std::nullopt;
    const double quotient = static_cast<double>(value.first) / static_cast<double>(value.second);
    return quotient > 0 && std::isfinite(quotient) ? std::optional(quotient) : std::nullopt;
  }

 private:
  const Exiv2::ExifData& data_;
};

std::optional<int> InRange(std::optional<long> value, long low, long high) {
  if (!value || *value < low || *value > high) return std::nullopt;
  return static_cast<int>(*value);
}

std::string LensOf(const Tags& tags) {
  std::string by_exif = tags.Text("Exif.Photo.LensModel");
  if (!by_exif.empty()) return by_exif;
  std::string by_id = tags.Printed("Exif.NikonLd3.LensIDNumber");
  // An id that Exiv2 does not know prints as a number in brackets; the focal range is then the better name.
  if (!by_id.empty() && by_id[0] != '(') return by_id;
  return tags.Printed("Exif.Nikon3.Lens");
}

std::string CommentOf(const Tags& tags) {
  const auto* tag = tags.Find("Exif.Photo.UserComment");
  if (tag == nullptr) return "";
  const auto* comment = dynamic_cast<const Exiv2::CommentValue*>(&tag->value());
  return comment == nullptr ? Trimmed(tag->toString()) : Trimmed(comment->comment());
}

std::string TakenAt(const Tags& tags) {
  std::string taken = tags.Text("Exif.Photo.DateTimeOriginal");
  const std::string fraction = tags.Text("Exif.Photo.SubSecTimeOriginal");
  if (!taken.empty() && !fraction.empty()) taken += "." + fraction;
  return taken;
}

PhotoMetadata FromTags(const Tags& tags) {
  PhotoMetadata found;
  found.make = tags.Text("Exif.Image.Make");
  found.model = tags.Text("Exif.Image.Model");
  found.body_serial = tags.Text("Exif.Nikon3.SerialNumber");
  if (found.body_serial.empty()) found.body_serial = tags.Text("Exif.Photo.BodySerialNumber");
  found.lens = LensOf(tags);
  found.exposure_s = tags.Positive("Exif.Photo.ExposureTime");
  found.f_number = tags.Positive("Exif.Photo.FNumber");
  found.focal_length_mm = tags.Positive("Exif.Photo.FocalLength");
  const auto distance = tags.Number("Exif.NikonLd3.FocusDistance");
  if (distance && *distance > 0 && *distance < 256) {
    found.focus_distance_m = 0.01 * std::pow(10.0, static_cast<double>(*distance) / 40.0);
  }
  found.iso = InRange(tags.Number("Exif.Photo.ISOSpeedRatings"), 1, 1000000);
  if (!found.iso) found.iso = InRange(tags.Number("Exif.Nikon3.ISOSpeed", 1), 1, 1000000);
  found.orientation = InRange(tags.Number("Exif.Image.Orientation"), 1, 8);
  found.shutter_count = InRange(tags.Number("Exif.Nikon3.ShutterCount"), 0, 100000000);
  if (const auto flash = tags.Number("Exif.Photo.Flash")) found.flash_fired = (*flash & 1) != 0;
  found.taken_at_camera_clock = TakenAt(tags);
  found.quality = tags.Text("Exif.Nikon3.Quality");
  found.focus_mode = tags.Text("Exif.Nikon3.Focus");
  found.white_balance = tags.Text("Exif.Nikon3.WhiteBalance");
  found.user_comment = CommentOf(tags);
  return found;
}

}  // namespace

Result<PhotoMetadata> ReadMetadata(std::span<const std::uint8_t> bytes) {
  const auto structure = CheckStructure(bytes);
  if (!structure) return Fail(structure.error());
  PhotoMetadata found;
  try {
    Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);  // it would write to stderr
    const auto image = Exiv2::ImageFactory::open(bytes.data(), static_cast<long>(bytes.size()));
    image->readMetadata();
    found = FromTags(Tags(image->exifData()));
  } catch (const std::exception&) {
    found = PhotoMetadata{};  // a whole photograph whose EXIF cannot be read counts as one without EXIF
  }
  found.width_px = structure->width_px;
  found.height_px = structure->height_px;
  return found;
}

}  // namespace striae::acquire
