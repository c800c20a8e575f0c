#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

#include "report/detail/codec.h"

namespace striae::report::detail {
namespace {

constexpr std::uint64_t kMostPixels = 100'000'000;

/// libjpeg reports errors by a call that must not return; we jump back into the caller.
struct ErrorManager {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

[[noreturn]] void JumpBack(j_common_ptr info) { std::longjmp(reinterpret_cast<ErrorManager*>(info->err)->back, 1); }
void Ignore(j_common_ptr) {}

}  // namespace

// No object with a destructor may be made between setjmp and a call that can jump: everything is declared before.
Result<ImageRgb> DecodeJpeg(std::span<const std::uint8_t> bytes) {
  jpeg_decompress_struct info;
  ErrorManager errors;
  ImageRgb image;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = JumpBack;
  errors.base.output_message = Ignore;
  if (setjmp(errors.back) != 0) {  // NOLINT(cert-err52-cpp): libjpeg knows no other way
    jpeg_destroy_decompress(&info);
    return Fail(ErrorCode::kBadImage, "the JPEG picture is damaged");
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&info, TRUE);
  if (static_cast<std::uint64_t>(info.image_width) * info.image_height > kMostPixels) {
    jpeg_destroy_decompress(&info);
    return Fail(ErrorCode::kBadImage, "the JPEG picture has more than 100 megapixels");
  }
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  image = ImageRgb(static_cast<int>(info.output_width), static_cast<int>(info.output_height));
  while (info.output_scanline < info.output_height) {
    static_assert(sizeof(Rgb8) == 3);
    JSAMPROW row = reinterpret_cast<JSAMPROW>(image.Row(static_cast<int>(info.output_scanline)));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return image;
}

Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& image, int quality) {
  jpeg_compress_struct info;
  ErrorManager errors;
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = JumpBack;
  errors.base.output_message = Ignore;
  if (setjmp(errors.back) != 0) {  // NOLINT(cert-err52-cpp)
    jpeg_destroy_compress(&info);
    std::free(buffer);
    return Fail(ErrorCode::kInternal, "the picture could not be written as JPEG");
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &buffer, &size);
  info.image_width = static_cast<JDIMENSION>(image.width());
  info.image_height = static_cast<JDIMENSION>(image.height());
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.dct_method = JDCT_ISLOW;  // the same bytes with and without SIMD
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = reinterpret_cast<JSAMPROW>(const_cast<Rgb8*>(image.Row(static_cast<int>(info.next_scanline))));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::vector<std::uint8_t> bytes(buffer, buffer + size);
  std::free(buffer);
  return bytes;
}

}  // namespace striae::report::detail
