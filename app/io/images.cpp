#include "app/io/images.h"

#include <string>

#include <opencv2/imgcodecs.hpp>

namespace striae::app {
namespace {

Result<std::vector<std::uint8_t>> Encode(const char* extension, const cv::Mat& mat) {
  try {
    std::vector<std::uint8_t> bytes;
    if (cv::imencode(extension, mat, bytes)) return bytes;
    return Fail(ErrorCode::kInternal, std::string("OpenCV cannot encode ") + extension);
  } catch (const cv::Exception& e) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV cannot encode ") + extension + ": " + e.err);
  }
}

}  // namespace

Result<std::vector<std::uint8_t>> EncodeFloatTiff(const ImageF& image) {
  // OpenCV's Mat cannot be made over const memory; imencode only reads it.
  return Encode(".tiff", cv::Mat(image.height(), image.width(), CV_32F, const_cast<float*>(image.Row(0))));
}

Result<std::vector<std::uint8_t>> EncodeMaskPng(const Mask& mask) {
  cv::Mat mat(mask.height(), mask.width(), CV_8U);
  for (int row = 0; row < mask.height(); ++row) {
    for (int col = 0; col < mask.width(); ++col) mat.at<std::uint8_t>(row, col) = mask(col, row) != 0 ? 255 : 0;
  }
  return Encode(".png", mat);
}

}  // namespace striae::app
