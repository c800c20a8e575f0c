#include "acquire/rig/detail/exif.h"

#include <exiv2/exiv2.hpp>

namespace striae::rig::detail {
namespace {

constexpr std::uint16_t kFlashFired = 0x0F;  // fired, compulsory, return light detected: as the pop-up flash in TTL

Exiv2::ExifData Tags(const CameraTags& tags, int width, int height) {
  Exiv2::ExifData exif;
  exif["Exif.Image.Make"] = "NIKON CORPORATION";
  exif["Exif.Image.Model"] = "NIKON D90";
  exif["Exif.Image.Orientation"] = static_cast<std::uint16_t>(tags.orientation);
  exif["Exif.Image.XResolution"] = Exiv2::Rational(300, 1);
  exif["Exif.Image.YResolution"] = Exiv2::Rational(300, 1);
  exif["Exif.Image.ResolutionUnit"] = std::uint16_t{2};
  exif["Exif.Image.Software"] = "Ver.1.00";
  exif["Exif.Image.DateTime"] = tags.taken;
  exif["Exif.Photo.ExposureTime"] = Exiv2::Rational(1, 200);
  exif["Exif.Photo.FNumber"] = Exiv2::Rational(11, 1);
  exif["Exif.Photo.ExposureProgram"] = std::uint16_t{1};  // manual
  exif["Exif.Photo.ISOSpeedRatings"] = static_cast<std::uint16_t>(tags.iso);
  exif["Exif.Photo.ExifVersion"] = "48 50 50 49";
  exif["Exif.Photo.DateTimeOriginal"] = tags.taken;
  exif["Exif.Photo.DateTimeDigitized"] = tags.taken;
  exif["Exif.Photo.SubSecTime"] = tags.subsecond;
  exif["Exif.Photo.SubSecTimeOriginal"] = tags.subsecond;
  exif["Exif.Photo.SubSecTimeDigitized"] = tags.subsecond;
  exif["Exif.Photo.Flash"] = kFlashFired;
  exif["Exif.Photo.FocalLength"] = Exiv2::Rational(50, 1);
  exif["Exif.Photo.FocalLengthIn35mmFilm"] = std::uint16_t{75};
  exif["Exif.Photo.ColorSpace"] = std::uint16_t{1};
  exif["Exif.Photo.PixelXDimension"] = static_cast<std::uint32_t>(width);
  exif["Exif.Photo.PixelYDimension"] = static_cast<std::uint32_t>(height);
  exif["Exif.Photo.ExposureMode"] = std::uint16_t{1};
  exif["Exif.Nikon3.Version"] = "48 50 49 48";
  exif["Exif.Nikon3.Quality"] = "FINE  ";
  exif["Exif.Nikon3.Focus"] = "MANUAL";
  exif["Exif.Nikon3.SerialNumber"] = tags.serial;
  return exif;
}

}  // namespace

Result<std::vector<std::uint8_t>> AddExif(const std::vector<std::uint8_t>& jpeg, const CameraTags& tags, int width,
                                          int height) {
  if (tags.orientation < 1 || tags.orientation > 8 || tags.iso < 1 || tags.iso > 65535) {
    return Fail(ErrorCode::kUsage, "EXIF orientation must lie between 1 and 8 and ISO between 1 and 65535");
  }
  try {
    auto image = Exiv2::ImageFactory::open(jpeg.data(), static_cast<long>(jpeg.size()));
    image->setExifData(Tags(tags, width, height));
    image->writeMetadata();
    Exiv2::BasicIo& io = image->io();
    const auto size = static_cast<std::size_t>(io.size());
    const Exiv2::byte* bytes = io.mmap();
    std::vector<std::uint8_t> tagged(bytes, bytes + size);
    io.munmap();
    return tagged;
  } catch (const Exiv2::AnyError& error) {
    return Fail(ErrorCode::kInternal, std::string("Exiv2 cannot tag the photograph: ") + error.what());
  }
}

}  // namespace striae::rig::detail
