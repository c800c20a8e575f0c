#include "acquire/structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/ptp_photo.h"

namespace striae::acquire {
namespace {

using ::striae::testing::MakeJpeg;
using ::striae::testing::MakeNef;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes Cut(const Bytes& bytes, std::size_t size) { return {bytes.begin(), bytes.begin() + static_cast<long>(size)}; }

TEST(JpegStructure, AWholePhotographIsWhole) {
  const Bytes photo = MakeJpeg();
  const auto found = CheckStructure(photo);
  ASSERT_TRUE(found) << found.error().Describe();
  EXPECT_EQ(found->media_type, "image/jpeg");
  EXPECT_EQ(found->width_px, 4288);
  EXPECT_EQ(found->height_px, 2848);
  EXPECT_EQ(found->image_bytes, photo.size());
  EXPECT_EQ(found->trailing_bytes, 0U);
}

TEST(JpegStructure, EveryTruncationIsNoticed) {
  testing::PhotoOptions small;
  small.width = 64;
  small.height = 48;
  const Bytes photo = MakeJpeg(small);
  for (std::size_t size = 0; size < photo.size(); ++size) {
    const auto found = CheckStructure(Cut(photo, size));
    ASSERT_FALSE(found) << "cut after " << size << " of " << photo.size() << " bytes";
    EXPECT_EQ(found.error().code, ErrorCode::kBadImage);
  }
}

TEST(JpegStructure, TheTruncationIsNamedWithItsPlace) {
  const Bytes photo = MakeJpeg();
  const auto found = CheckStructure(Cut(photo, photo.size() / 2));
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("truncated JPEG"));
  EXPECT_THAT(found.error().message, HasSubstr(std::to_string(photo.size() / 2) + " bytes"));
}

TEST(JpegStructure, ATailOfZerosInsteadOfPictureIsTruncation) {  // what a failing card leaves: right size, no content
  Bytes photo = MakeJpeg();
  std::fill(photo.end() - 1000, photo.end(), std::uint8_t{0});
  EXPECT_FALSE(CheckStructure(photo));
}

TEST(JpegStructure, BytesAfterTheEndAreCountedNotRefused) {
  Bytes photo = MakeJpeg();
  photo.resize(photo.size() + 512, 0xAB);
  const auto found = CheckStructure(photo);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->trailing_bytes, 512U);
}

TEST(JpegStructure, GarbageBetweenSegmentsIsDamage) {
  Bytes photo = MakeJpeg();
  const Bytes garbage(64, 0x5A);
  photo.insert(photo.begin() + 2, garbage.begin(), garbage.end());
  const auto found = CheckStructure(photo);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("damaged JPEG"));
}

TEST(JpegStructure, AThumbnailsEndIsNotThePicturesEnd) {
  // EXIF carries a whole JPEG of its own; a search for the end marker alone would be content with it.
  testing::PhotoOptions small;
  small.width = small.height = 16;
  small.with_exif = false;
  const Bytes thumbnail = MakeJpeg(small);
  Bytes photo = MakeJpeg(small);
  Bytes segment{0xFF, 0xE1, static_cast<std::uint8_t>((thumbnail.size() + 2) >> 8),
                static_cast<std::uint8_t>(thumbnail.size() + 2)};
  segment.insert(segment.end(), thumbnail.begin(), thumbnail.end());
  photo.insert(photo.begin() + 2, segment.begin(), segment.end());
  EXPECT_TRUE(CheckStructure(photo));
  EXPECT_FALSE(CheckStructure(Cut(photo, photo.size() - 2)));
}

TEST(Structure, WhatIsNotAPhotographIsRefusedWithAdvice) {
  const std::string text = "%PDF-1.7 not a photograph";
  const auto found = CheckStructure(Bytes(text.begin(), text.end()));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::kBadImage);
  EXPECT_THAT(found.error().message, HasSubstr("neither a JPEG nor a Nikon NEF"));
  EXPECT_THAT(CheckStructure({}).error().message, HasSubstr("empty"));
}

TEST(NefStructure, AWholeRawFileHasItsRawSize) {
  const Bytes photo = MakeNef();
  const auto found = CheckStructure(photo);
  ASSERT_TRUE(found) << found.error().Describe();
  EXPECT_EQ(found->media_type, "image/x-nikon-nef");
  EXPECT_EQ(found->width_px, 4288);  // the raw picture's, not the preview's 570 x 375
  EXPECT_EQ(found->height_px, 2848);
  EXPECT_EQ(found->image_bytes, photo.size());
}

TEST(NefStructure, EveryTruncationIsNoticed) {
  const Bytes photo = MakeNef({}, 64);
  for (std::size_t size = 0; size < photo.size(); ++size) {
    EXPECT_FALSE(CheckStructure(Cut(photo, size))) << "cut after " << size << " of " << photo.size() << " bytes";
  }
}

TEST(NefStructure, AnotherMakersTiffIsNotANef) {
  testing::PhotoOptions other;
  other.make = "Scanner Works";
  const auto found = CheckStructure(MakeNef(other));
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("Nikon"));
}

TEST(NefStructure, DirectoriesThatPointInACircleEnd) {
  Bytes photo = MakeNef();
  // The link to the next directory stands behind IFD0's entries; point it back at IFD0.
  const std::size_t entries = static_cast<std::size_t>(photo[8]) * 256 + photo[9];
  photo[8 + 2 + 12 * entries + 3] = 8;
  EXPECT_FALSE(CheckStructure(photo));
}

}  // namespace
}  // namespace striae::acquire
