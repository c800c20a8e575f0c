#include "acquire/rig/detail/exif.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <exiv2/exiv2.hpp>

namespace striae::rig::detail {
namespace {

constexpr std::uint16_t kFlashFired = 0x0F;  // fired, compulsory, return light detected: as the pop-up flash in TTL

/// Nikon's scale of distances: 0.01 m * 10^(code / 40).
std::uint8_t FocusCode(double focus_mm) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(40 * std::log10(focus_mm / 10)), 1L, 255L));
}

void AddMakerNote(const CameraTags& tags, int width, int height, Exiv2::ExifData& exif) {
  exif["Exif.Nikon3.Version"] = "48 50 49 48";
  exif["Exif.Nikon3.ISOSpeed"] = "0 " + std::to_string(tags.iso);
  exif["Exif.Nikon3.Quality"] = "FINE   ";
  exif["Exif.Nikon3.WhiteBalance"] = "FLASH       ";
  exif["Exif.Nikon3.Focus"] = "MANUAL ";
  exif["Exif.Nikon3.FlashSetting"] = "NORMAL      ";
  exif["Exif.Nikon3.FlashDevice"] = "Built-in,M         ";
  exif["Exif.Nikon3.SerialNumber"] = tags.serial;
  exif["Exif.Nikon3.ActiveDLighting"] = "0";
  exif["Exif.Nikon3.LensType"] = "6";  // D and G: no aperture ring
  exif["Exif.Nikon3.Lens"] = "500/10 500/10 18/10 18/10";
  exif["Exif.Nikon3.FlashMode"] = "7";  // built-in flash fired
  exif["Exif.Nikon3.ShutterCount"] = std::to_string(tags.shutter_count);
  exif["Exif.Nikon3.ImageBoundary"] = "0 0 " + std::to_string(width) + " " + std::to_string(height);
  exif["Exif.NikonLd3.Version"] = "48 50 48 52";
  exif["Exif.NikonLd3.FocusDistance"] = std::to_string(FocusCode(tags.focus_mm));
  exif["Exif.NikonLd3.FocalLength"] = "81";  // 5 mm * 2^(code / 24) = 50 mm
  exif["Exif.NikonLd3.LensIDNumber"] = "176";
  exif["Exif.NikonLd3.MinFocalLength"] = "80";
  exif["Exif.NikonLd3.MaxFocalLength"] = "80";
}

Exiv2::ExifData Tags(const CameraTags& tags, int width, int height) {
  Exiv2::ExifData exif;
  exif["Exif.Image.Make"] = "NIKON CORPORATION";
  exif["Exif.Image.Model"] = "NIKON D90";
  exif["Exif.Image.Orientation"] = static_cast<std::uint16_t>(tags.orientation);
  exif["Exif.Image.XResolution"] = Exiv2::Rational(300, 1);
  exif["Exif.Image.YResolution"] = Exiv2::Rational(300, 1);
  exif["Exif.Image.ResolutionUnit"] = std::uint16_t{2};
  exif["Exif.Image.Software"] = "Ver.1.00 ";
  exif["Exif.Image.DateTime"] = tags.taken;
  exif["Exif.Image.YCbCrPositioning"] = std::uint16_t{2};
  exif["Exif.Photo.ExposureTime"] = Exiv2::Rational(1, 200);
  exif["Exif.Photo.FNumber"] = Exiv2::Rational(11, 1);
  exif["Exif.Photo.ExposureProgram"] = std::uint16_t{1};  // manual
  exif["Exif.Photo.ISOSpeedRatings"] = static_cast<std::uint16_t>(tags.iso);
  exif["Exif.Photo.ExifVersion"] = "48 50 50 49";
  exif["Exif.Photo.DateTimeOriginal"] = tags.taken;
  exif["Exif.Photo.DateTimeDigitized"] = tags.taken;
  exif["Exif.Photo.ComponentsConfiguration"] = "1 2 3 0";
  exif["Exif.Photo.CompressedBitsPerPixel"] = "4/1";
  exif["Exif.Photo.ExposureBiasValue"] = "0/6";
  exif["Exif.Photo.MaxApertureValue"] = "17/10";
  exif["Exif.Photo.MeteringMode"] = std::uint16_t{5};
  exif["Exif.Photo.LightSource"] = std::uint16_t{0};
  exif["Exif.Photo.Flash"] = kFlashFired;
  exif["Exif.Photo.FocalLength"] = Exiv2::Rational(50, 1);
  exif["Exif.Photo.SubSecTime"] = tags.subsecond;
  exif["Exif.Photo.SubSecTimeOriginal"] = tags.subsecond;
  exif["Exif.Photo.SubSecTimeDigitized"] = tags.subsecond;
  exif["Exif.Photo.FlashpixVersion"] = "48 49 48 48";
  exif["Exif.Photo.ColorSpace"] = std::uint16_t{1};
  exif["Exif.Photo.PixelXDimension"] = static_cast<std::uint32_t>(width);
  exif["Exif.Photo.PixelYDimension"] = static_cast<std::uint32_t>(height);
  exif["Exif.Photo.SensingMethod"] = std::uint16_t{2};
  exif["Exif.Photo.FileSource"] = "3";
  exif["Exif.Photo.SceneType"] = "1";
  exif["Exif.Photo.CustomRendered"] = std::uint16_t{0};
  exif["Exif.Photo.ExposureMode"] = std::uint16_t{1};
  exif["Exif.Photo.WhiteBalance"] = std::uint16_t{1};
  exif["Exif.Photo.FocalLengthIn35mmFilm"] = std::uint16_t{75};
  exif["Exif.Photo.SceneCaptureType"] = std::uint16_t{0};
  AddMakerNote(tags, width, height, exif);
  return exif;
}

}  // namespace

Result<std::vector<std::uint8_t>> AddExif(const std::vector<std::uint8_t>& jpeg, const CameraTags& tags, int width,
                                          int height) {
  if (tags.orientation < 1 || tags.orientation > 8 || tags.iso < 1 || tags.iso > 65535) {
    return Fail(ErrorCode::kUsage, "EXIF orientation must lie between 1 and 8 and ISO between 1 and 65535");
  }
  if (!(tags.focus_mm > 0) || !std::isfinite(tags.focus_mm)) {
    return Fail(ErrorCode::kUsage, "the EXIF focus distance must be positive");
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
