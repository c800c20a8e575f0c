#include "app/io/photograph.h"

#include <exception>
#include <string>
#include <vector>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/io/image_header.h"
#include "app/io/jpeg.h"
#include "app/io/luminance.h"
#include "app/io/raw.h"

namespace striae::app {
namespace {

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage, what + "; take the file from the camera's card again");
}

/// `T` is the type of one channel. 16-bit values become 8 for display; luminance keeps all of them.
template <typename T>
Photograph FromMat(const cv::Mat& mat) {
  constexpr bool kDeep = sizeof(T) == 2;
  constexpr float kScale = kDeep ? 1.0F / 65535 : 1.0F / 255;
  Photograph photograph{ImageF::Unset(mat.cols, mat.rows), ImageRgb::Unset(mat.cols, mat.rows), kSaturated8};
  // 65535 = 257 * 255: rounded to the nearest, never a tie.
  const auto byte = [](T value) -> std::uint8_t {
    return kDeep ? static_cast<std::uint8_t>((value + 128U) / 257U) : static_cast<std::uint8_t>(value);
  };
  const int channels = mat.channels();
  for (int row = 0; row < mat.rows; ++row) {
    const T* in = mat.ptr<T>(row);
    float* luminance = photograph.luminance.Row(row);
    Rgb8* colour = photograph.colour.Row(row);
    for (int col = 0; col < mat.cols; ++col, in += channels) {
      const T b = in[0], g = channels > 1 ? in[1] : b, r = channels > 1 ? in[2] : b;
      luminance[col] = kScale * (channels > 1 ? Luminance(r, g, b) : static_cast<float>(b));
      colour[col] = {byte(r), byte(g), byte(b)};
    }
  }
  return photograph;
}

/// Through OpenCV, whose exceptions end here.
Result<Photograph> DecodeOther(std::span<const std::uint8_t> bytes, const ImageHeader& header) {
  try {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // what is wrong is said once, by Striae
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::uint8_t*>(bytes.data()));
    const cv::Mat mat = cv::imdecode(raw, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    if (mat.empty()) return Bad("the PNG, TIFF or BMP is truncated, damaged or of an unusual kind");
    if (mat.cols != header.width || mat.rows != header.height) return Bad("the image contradicts its own header");
    if (mat.channels() != 1 && mat.channels() != 3) return Bad("only grey and colour images are read");
    if (mat.depth() == CV_8U) return FromMat<std::uint8_t>(mat);
    if (mat.depth() == CV_16U) return FromMat<std::uint16_t>(mat);
    return Bad("only 8 and 16 bit images are read");
  } catch (const std::exception& e) {
    return Bad(std::string("the image cannot be decoded (") + e.what() + ")");
  }
}

}  // namespace

Result<Photograph> DecodePhotograph(std::span<const std::uint8_t> bytes) {
  const auto header = ReadImageHeader(bytes);
  if (!header) return Fail(header.error());
  if (header->kind == ImageKind::kJpeg) return DecodeJpeg(bytes);
  if (header->kind == ImageKind::kRaw) return DecodeRaw(bytes);
  return DecodeOther(bytes, *header);
}

}  // namespace striae::app
