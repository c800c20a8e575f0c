#include "acquire/rig/photograph_file.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "acquire/rig/detail/exif.h"

namespace striae::rig {

Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& photograph, const CameraTags& tags, int quality) {
  if (quality < 1 || quality > 100) return Fail(ErrorCode::kUsage, "JPEG quality must lie between 1 and 100");
  cv::Mat bgr(photograph.height(), photograph.width(), CV_8UC3);
  for (int row = 0; row < photograph.height(); ++row) {
    auto* out = bgr.ptr<cv::Vec3b>(row);
    const Rgb8* in = photograph.Row(row);
    for (int col = 0; col < photograph.width(); ++col) out[col] = {in[col].b, in[col].g, in[col].r};
  }
  try {
    std::vector<std::uint8_t> jpeg;
    if (bgr.empty() || !cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality})) {
      return Fail(ErrorCode::kUsage, "there is no image to write");
    }
    return detail::AddExif(jpeg, tags, photograph.width(), photograph.height());
  } catch (const cv::Exception& error) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV cannot encode the photograph: ") + error.what());
  }
}

}  // namespace striae::rig
