#include "app/io/photograph.h"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/test_data.h"

namespace striae::app {
namespace {

/// Red grows with the column, green with the row.
std::vector<std::uint8_t> Encoded(const char* extension, int type) {
  cv::Mat mat(48, 64, type);
  const double full = mat.depth() == CV_16U ? 65535 : 255;
  for (int row = 0; row < mat.rows; ++row) {
    for (int col = 0; col < mat.cols; ++col) {
      const double r = full * col / 63, g = full * row / 47;
      if (type == CV_8UC3) mat.at<cv::Vec3b>(row, col) = cv::Vec3b(0, static_cast<uchar>(g), static_cast<uchar>(r));
      if (type == CV_16UC3) mat.at<cv::Vec3w>(row, col) = cv::Vec3w(0, static_cast<ushort>(g), static_cast<ushort>(r));
      if (type == CV_8U) mat.at<uchar>(row, col) = static_cast<uchar>(r);
      if (type == CV_16U) mat.at<ushort>(row, col) = static_cast<ushort>(r);
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, mat, bytes);
  return bytes;
}

TEST(DecodePhotograph, ReadsEveryKindOfFile) {
  for (const char* extension : {".jpg", ".png", ".tiff", ".bmp"}) {
    for (const int type : {CV_8UC3, CV_8U}) {
      const auto photograph = DecodePhotograph(Encoded(extension, type));
      ASSERT_TRUE(photograph) << extension << photograph.error().message;
      EXPECT_EQ(photograph->luminance.width(), 64);
      EXPECT_EQ(photograph->luminance.height(), 48);
      EXPECT_LT(photograph->luminance(2, 2), photograph->luminance(60, 2)) << extension;
      EXPECT_GT(photograph->colour(63, 0).r, 235) << extension;
    }
  }
  for (const int type : {CV_16UC3, CV_16U}) {
    const auto photograph = DecodePhotograph(Encoded(".png", type));
    ASSERT_TRUE(photograph) << photograph.error().message;
    EXPECT_EQ(photograph->colour(63, 0).r, 255);
  }
}

TEST(DecodePhotograph, SixteenBitsKeepTheirFineSteps) {
  cv::Mat mat(40, 40, CV_16U, cv::Scalar(30000));
  mat.at<ushort>(5, 5) = 30040;  // a sixth of an 8 bit step
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", mat, bytes);
  const auto photograph = DecodePhotograph(bytes);
  ASSERT_TRUE(photograph);
  EXPECT_NEAR(photograph->luminance(5, 5) - photograph->luminance(6, 5), 40.0 / 65535, 1e-7);
}

TEST(DecodePhotograph, ATruncatedFileIsAnErrorAndNeverAGreyRest) {
  for (const char* extension : {".jpg", ".png", ".tiff", ".bmp"}) {
    const auto whole = Encoded(extension, CV_8UC3);
    for (const double share : {0.1, 0.5, 0.9, 0.99}) {
      const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
      const auto photograph = DecodePhotograph({whole.data(), size});
      ASSERT_FALSE(photograph) << extension << " " << share;
      EXPECT_EQ(photograph.error().code, ErrorCode::kBadImage);
    }
  }
}

TEST(DecodePhotograph, SixteenBitsAreReadFromTiffToo) {
  for (const int type : {CV_16UC3, CV_16U}) {
    const auto photograph = DecodePhotograph(Encoded(".tiff", type));
    ASSERT_TRUE(photograph) << photograph.error().message;
    // Red alone at the end of the first row: its share of the luminance, and all of it where there is only grey.
    EXPECT_NEAR(photograph->luminance(63, 0), type == CV_16U ? 1.0 : 0.2126, 1e-6);
    EXPECT_FALSE(photograph->linear);
  }
}

TEST(DecodePhotograph, RefusesWhatIsNoImage) {
  for (const std::string& text :
       {std::string(), std::string("GIF8"), std::string(1000, 'x'), std::string("\xff\xd8\xff\xe0 no")}) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    EXPECT_FALSE(DecodePhotograph(bytes)) << text.substr(0, 10);
  }
}

TEST(DecodePhotograph, GeometryIsTheSensorsWhateverTheOrientationTagSays) {
  STRIAE_NEED_DATA("nikon_d90/Nikon D90.jpg");
  std::ifstream file(testing::TestData("nikon_d90/Nikon D90.jpg"), std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto photograph = DecodePhotograph(bytes);
  ASSERT_TRUE(photograph) << photograph.error().message;
  EXPECT_EQ(photograph->luminance.width(), 4288);
  EXPECT_EQ(photograph->luminance.height(), 2848);
}

}  // namespace
}  // namespace striae::app
