#include "acquire/rig/files.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "acquire/rig/detail/exif.h"

namespace striae::rig {
namespace {

constexpr int kTiffNone = 1;  // TIFF compression tag: stored as it is

Result<std::vector<std::uint8_t>> Encode(const char* extension, const cv::Mat& image, const std::vector<int>& options) {
  if (image.empty()) return Fail(ErrorCode::kUsage, "there is no image to write");
  try {
    std::vector<std::uint8_t> bytes;
    if (cv::imencode(extension, image, bytes, options)) return bytes;
  } catch (const cv::Exception& error) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV cannot encode the image: ") + error.what());
  }
  return Fail(ErrorCode::kInternal, "OpenCV cannot encode the image");
}

}  // namespace

Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& photograph, const CameraTags& tags, int quality) {
  if (quality < 1 || quality > 100) return Fail(ErrorCode::kUsage, "JPEG quality must lie between 1 and 100");
  cv::Mat bgr(photograph.height(), photograph.width(), CV_8UC3);
  for (int row = 0; row < photograph.height(); ++row) {
    auto* out = bgr.ptr<cv::Vec3b>(row);
    const Rgb8* in = photograph.Row(row);
    for (int col = 0; col < photograph.width(); ++col) out[col] = {in[col].b, in[col].g, in[col].r};
  }
  auto bytes = Encode(".jpg", bgr, {cv::IMWRITE_JPEG_QUALITY, quality});
  if (!bytes) return bytes;
  return detail::AddExif(*bytes, tags, photograph.width(), photograph.height());
}

Result<std::vector<std::uint8_t>> EncodeFloatTiff(const ImageF& image) {
  const cv::Mat view(image.height(), image.width(), CV_32FC1, const_cast<float*>(image.pixels().data()));
  return Encode(".tiff", view, {cv::IMWRITE_TIFF_COMPRESSION, kTiffNone});
}

Result<std::vector<std::uint8_t>> EncodeMaskPng(const Mask& mask) {
  const cv::Mat view(mask.height(), mask.width(), CV_8UC1, const_cast<std::uint8_t*>(mask.pixels().data()));
  return Encode(".png", view * 255, {});
}

}  // namespace striae::rig
