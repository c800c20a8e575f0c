#include "app/io/photograph.h"

#include <csetjmp>
#include <cstdio>
#include <string>
#include <vector>

#include <jpeglib.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace striae::app {
namespace {

constexpr std::size_t kMostPixels = 200'000'000;
constexpr float kSaturated8 = 254.0F / 255;

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage, what + "; take the file from the camera's card again");
}

/// Rec. 709 weights on the encoded values: close to what the flash and skin give, and never above full scale.
float Luminance(float r, float g, float b) { return 0.2126F * r + 0.7152F * g + 0.0722F * b; }

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX] = "";
};

[[noreturn]] void Stop(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  errors->base.format_message(info, errors->text);
  std::longjmp(errors->back, 1);
}

/// libjpeg goes on after "premature end of file" with grey: for a measurement every warning is an error.
void StopOnWarning(j_common_ptr info, int level) {
  if (level < 0) Stop(info);
}

/// Reads rows into `rgb` (sized by the caller once the header is known). False with errors.text set on failure. Only
/// trivially destructible locals here: longjmp skips destructors.
bool DecodeRows(jpeg_decompress_struct& info, JpegErrors& errors, ImageRgb& rgb) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    auto* row = reinterpret_cast<JSAMPROW>(rgb.Row(static_cast<int>(info.output_scanline)));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

bool ReadHeader(jpeg_decompress_struct& info, JpegErrors& errors, std::span<const std::uint8_t> bytes) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  return true;
}

Result<ImageRgb> DecodeJpeg(std::span<const std::uint8_t> bytes) {
  static_assert(sizeof(Rgb8) == 3, "rows are decoded straight into the image");
  jpeg_decompress_struct info{};
  JpegErrors errors;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = Stop;
  errors.base.emit_message = StopOnWarning;
  jpeg_create_decompress(&info);
  ImageRgb rgb;
  bool good = ReadHeader(info, errors, bytes);
  if (good && static_cast<std::size_t>(info.image_width) * info.image_height > kMostPixels) {
    jpeg_destroy_decompress(&info);
    return Bad("the JPEG has more than 200 megapixels");
  }
  if (good) {
    rgb = ImageRgb(static_cast<int>(info.image_width), static_cast<int>(info.image_height));
    good = DecodeRows(info, errors, rgb);
  }
  jpeg_destroy_decompress(&info);
  if (!good) return Bad("the JPEG is truncated or damaged (" + std::string(errors.text) + ")");
  return rgb;
}

/// 16-bit values to 8 for display; luminance keeps all of them.
Photograph FromMat(const cv::Mat& mat) {
  Photograph photograph{ImageF(mat.cols, mat.rows), ImageRgb(mat.cols, mat.rows), kSaturated8};
  const bool deep = mat.depth() == CV_16U;
  const float scale = deep ? 1.0F / 65535 : 1.0F / 255;
  const int channels = mat.channels();
  const auto value = [&](int row, int index) -> float {
    return scale * (deep ? static_cast<float>(mat.ptr<std::uint16_t>(row)[index])
                         : static_cast<float>(mat.ptr<std::uint8_t>(row)[index]));
  };
  // 65535 = 257 * 255: rounded to the nearest, never a tie.
  const auto byte = [&](int row, int index) -> std::uint8_t {
    return deep ? static_cast<std::uint8_t>((mat.ptr<std::uint16_t>(row)[index] + 128U) / 257U)
                : mat.ptr<std::uint8_t>(row)[index];
  };
  for (int row = 0; row < mat.rows; ++row) {
    for (int col = 0; col < mat.cols; ++col) {
      const int at = col * channels;
      const float b = value(row, at), g = channels > 1 ? value(row, at + 1) : b,
                  r = channels > 1 ? value(row, at + 2) : b;
      photograph.luminance(col, row) = channels > 1 ? Luminance(r, g, b) : b;
      const std::uint8_t blue = byte(row, at);
      photograph.colour(col, row) =
          channels > 1 ? Rgb8{byte(row, at + 2), byte(row, at + 1), blue} : Rgb8{blue, blue, blue};
    }
  }
  return photograph;
}

Photograph FromRgb(ImageRgb rgb) {
  Photograph photograph{ImageF(rgb.width(), rgb.height()), {}, kSaturated8};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const Rgb8 c = rgb.pixels()[i];
    photograph.luminance.pixels()[i] = Luminance(c.r, c.g, c.b) / 255;
  }
  photograph.colour = std::move(rgb);
  return photograph;
}

}  // namespace

Result<Photograph> DecodePhotograph(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4) return Bad("the file is empty or no image");
  if (bytes[0] == 0xff && bytes[1] == 0xd8) {
    auto rgb = DecodeJpeg(bytes);
    if (!rgb) return Fail(rgb.error());
    return FromRgb(*std::move(rgb));
  }
  try {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::uint8_t*>(bytes.data()));
    const cv::Mat mat = cv::imdecode(raw, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    if (mat.empty()) return Bad("this is no readable JPEG, PNG, TIFF or BMP");
    if (mat.total() > kMostPixels) return Bad("the image has more than 200 megapixels");
    if (mat.depth() != CV_8U && mat.depth() != CV_16U) return Bad("only 8 and 16 bit images are read");
    return FromMat(mat);
  } catch (const cv::Exception& e) {
    return Bad("the image cannot be decoded (" + e.err + ")");
  }
}

}  // namespace striae::app
