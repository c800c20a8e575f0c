#include <cstring>

#include "report/detail/cairo_paint.h"
#include "report/detail/codec.h"

namespace striae::report::detail {
namespace {

constexpr std::uint64_t kMostPixels = 100'000'000;

cairo_status_t ReadSome(void* closure, unsigned char* data, unsigned int length) {
  auto& rest = *static_cast<std::span<const std::uint8_t>*>(closure);
  if (length > rest.size()) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, rest.data(), length);
  rest = rest.subspan(length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_status_t Append(void* closure, const unsigned char* data, unsigned int length) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(closure);
  bytes.insert(bytes.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

std::uint32_t BigEndian(std::span<const std::uint8_t> bytes) {
  return (static_cast<std::uint32_t>(bytes[0]) << 24U) | (static_cast<std::uint32_t>(bytes[1]) << 16U) |
         (static_cast<std::uint32_t>(bytes[2]) << 8U) | bytes[3];
}

}  // namespace

ImageRgb FromCairo(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  ImageRgb image(cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4, 4);
      image(x, y) = {static_cast<std::uint8_t>(pixel >> 16U), static_cast<std::uint8_t>(pixel >> 8U),
                     static_cast<std::uint8_t>(pixel)};
    }
  }
  return image;
}

Result<ImageRgb> DecodePng(std::span<const std::uint8_t> bytes) {
  // The size stands in the header, before any memory is asked for.
  if (bytes.size() < 33 ||
      static_cast<std::uint64_t>(BigEndian(bytes.subspan(16))) * BigEndian(bytes.subspan(20)) > kMostPixels) {
    return Fail(ErrorCode::kBadImage, "the PNG picture is cut off or has more than 100 megapixels");
  }
  std::span<const std::uint8_t> rest = bytes;
  const SurfacePtr read(cairo_image_surface_create_from_png_stream(ReadSome, &rest));
  if (cairo_surface_status(read.get()) != CAIRO_STATUS_SUCCESS) {
    return Fail(ErrorCode::kBadImage, "the PNG picture is damaged");
  }
  // Painted on white: whatever its format and transparency, the result is RGB.
  const SurfacePtr white = ToCairo(
      ImageRgb(cairo_image_surface_get_width(read.get()), cairo_image_surface_get_height(read.get()), {255, 255, 255}));
  const ContextPtr context(cairo_create(white.get()));
  cairo_set_source_surface(context.get(), read.get(), 0, 0);
  cairo_paint(context.get());
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS)
    return Fail(ErrorCode::kBadImage, "the PNG picture is damaged");
  return FromCairo(white.get());
}

Result<std::vector<std::uint8_t>> EncodePng(const ImageRgb& image) {
  const SurfacePtr surface = ToCairo(image);
  std::vector<std::uint8_t> bytes;
  if (cairo_surface_write_to_png_stream(surface.get(), Append, &bytes) != CAIRO_STATUS_SUCCESS) {
    return Fail(ErrorCode::kInternal, "the picture could not be written as PNG");
  }
  return bytes;
}

}  // namespace striae::report::detail
