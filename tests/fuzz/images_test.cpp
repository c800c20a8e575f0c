// Bytes of any kind through the readers of photographs: a photograph or an error that says so, never a crash, never
// memory without bound. The corpus is made here, the damage from a fixed seed: the same files every time.
#include <chrono>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "app/io/image_header.h"
#include "app/io/photograph.h"
#include "tests/support/dng.h"

namespace striae::app {
namespace {

using Bytes = std::vector<std::uint8_t>;

void ReadAnything(const Bytes& bytes) {
  const auto photograph = DecodePhotograph(bytes);
  if (!photograph) {
    EXPECT_EQ(photograph.error().code, ErrorCode::kBadImage);
    EXPECT_FALSE(photograph.error().message.empty());
    return;
  }
  EXPECT_GT(photograph->luminance.size(), 0U);
  EXPECT_EQ(photograph->luminance.width(), photograph->colour.width());
  EXPECT_EQ(photograph->luminance.height(), photograph->colour.height());
  for (const float value : photograph->luminance.pixels()) ASSERT_TRUE(value >= 0 && value <= 1.0001F) << value;
}

/// Small pictures of every kind that is read.
std::vector<Bytes> Corpus() {
  cv::Mat colour(20, 28, CV_8UC3), deep(20, 28, CV_16UC1);
  for (int row = 0; row < colour.rows; ++row) {
    for (int col = 0; col < colour.cols; ++col) {
      colour.at<cv::Vec3b>(row, col) = cv::Vec3b(static_cast<uchar>(9 * col), static_cast<uchar>(12 * row), 77);
      deep.at<ushort>(row, col) = static_cast<ushort>(2000 * col + 31 * row);
    }
  }
  std::vector<Bytes> corpus;
  for (const char* extension : {".jpg", ".png", ".tiff", ".bmp"}) {
    corpus.emplace_back();
    cv::imencode(extension, colour, corpus.back());
  }
  for (const char* extension : {".png", ".tiff"}) {
    corpus.emplace_back();
    cv::imencode(extension, deep, corpus.back());
  }
  corpus.emplace_back();
  cv::imencode(".jpg", colour, corpus.back(), {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  corpus.push_back(testing::MakeDng({.width = 40, .height = 30},
                                    [](int col, int row, int) { return static_cast<std::uint16_t>(300 * col + row); }));
  return corpus;
}

TEST(FuzzImages, TheCorpusItselfIsRead) {
  for (const Bytes& seed : Corpus()) EXPECT_TRUE(DecodePhotograph(seed).has_value());
}

TEST(FuzzImages, EveryByteOfTheHeadersMayBeWrong) {
  constexpr std::size_t kHead = 220;
  for (const Bytes& seed : Corpus()) {
    for (std::size_t at = 0; at < seed.size(); ++at) {
      if (at >= kHead && at + kHead < seed.size()) continue;  // directories of TIFFs stand at the end
      for (const int value : {0x00, 0xFF, seed[at] ^ 0x01}) {
        Bytes changed = seed;
        changed[at] = static_cast<std::uint8_t>(value);
        // What the header then asks for is refused or small: a large picture from few bytes is decoded once, not often.
        const auto header = ReadImageHeader(changed);
        if (header && header->width * header->height > 2'000'000) continue;
        ReadAnything(changed);
      }
    }
  }
}

TEST(FuzzImages, RandomDamageAndCuts) {
  std::mt19937 random(20261122);
  for (const Bytes& seed : Corpus()) {
    for (int round = 0; round < 120; ++round) {
      Bytes changed = seed;
      const int edits = 1 + static_cast<int>(random() % 6);
      for (int edit = 0; edit < edits; ++edit) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
      if (random() % 3 == 0) changed.resize(random() % changed.size());
      const auto header = ReadImageHeader(changed);
      if (header && header->width * header->height > 2'000'000) continue;
      ReadAnything(changed);
    }
  }
}

/// The size in a PNG's, BMP's or TIFF's header made 14142 x 14142 = 200 megapixels.
TEST(FuzzImages, TwoHundredMegapixelsAreRefusedByTheHeaderAlone) {
  cv::Mat grey(16, 16, CV_8UC1, cv::Scalar(9));
  Bytes png, bmp, jpeg;
  cv::imencode(".png", grey, png);
  cv::imencode(".bmp", grey, bmp);
  cv::imencode(".jpg", grey, jpeg);
  for (const std::size_t at : {std::size_t{16}, std::size_t{20}}) {
    png[at + 2] = 14142 >> 8;
    png[at + 3] = 14142 & 0xff;
  }
  for (const std::size_t at : {std::size_t{18}, std::size_t{22}}) {
    bmp[at] = 14142 & 0xff;
    bmp[at + 1] = 14142 >> 8;
  }
  for (std::size_t at = 2; at + 9 < jpeg.size(); ++at) {
    if (jpeg[at] != 0xff || jpeg[at + 1] != 0xc0) continue;
    for (const std::size_t size : {at + 5, at + 7}) {
      jpeg[size] = 14142 >> 8;
      jpeg[size + 1] = 14142 & 0xff;
    }
    break;
  }
  for (const Bytes& bytes : {png, bmp, jpeg}) {
    const auto photograph = DecodePhotograph(bytes);
    ASSERT_FALSE(photograph);
    EXPECT_NE(photograph.error().message.find("100 megapixels"), std::string::npos) << photograph.error().message;
  }
}

}  // namespace
}  // namespace striae::app
