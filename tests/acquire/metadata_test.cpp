#include "acquire/metadata.h"

#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/preflight.h"
#include "tests/support/files.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/test_data.h"

namespace striae::acquire {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// "[Exif SubIFD - 0x8827] ISO Speed Ratings = 250" -> {"Exif SubIFD - 0x8827": "250"}, from another reader's dump.
std::map<std::string, std::string> OtherReader(const std::filesystem::path& path) {
  std::map<std::string, std::string> tags;
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) {
    const auto bracket = line.find(']');
    const auto equals = line.find(" = ");
    if (line.empty() || line[0] != '[' || bracket == std::string::npos || equals == std::string::npos) continue;
    std::string value = line.substr(equals + 3);
    value.erase(value.find_last_not_of(" \r") + 1);
    tags[line.substr(1, bracket - 1)] = value;
  }
  return tags;
}

TEST(Metadata, AgreesWithAnotherReaderOnARealD90Photograph) {
  STRIAE_NEED_DATA("nikon_d90");
  const auto photo = ReadMetadata(testing::ReadBytes(testing::TestData("nikon_d90/Nikon D90.jpg")));
  ASSERT_TRUE(photo) << photo.error().Describe();
  auto other = OtherReader(testing::TestData("nikon_d90/Nikon D90.jpg.metadata-extractor.txt"));
  EXPECT_EQ(photo->make, other["Exif IFD0 - 0x010f"]);
  EXPECT_EQ(photo->model, other["Exif IFD0 - 0x0110"]);
  EXPECT_EQ(photo->body_serial, other["Nikon Makernote - 0x001d"]);
  EXPECT_EQ(std::to_string(photo->shutter_count.value_or(-1)), other["Nikon Makernote - 0x00a7"]);
  EXPECT_EQ(photo->quality, other["Nikon Makernote - 0x0004"]);
  EXPECT_EQ(photo->white_balance, other["Nikon Makernote - 0x0005"]);
  EXPECT_EQ(photo->focus_mode, other["Nikon Makernote - 0x0007"]);
  EXPECT_EQ(std::to_string(photo->iso.value_or(0)), other["Exif SubIFD - 0x8827"]);
  EXPECT_EQ(photo->taken_at_camera_clock, other["Exif SubIFD - 0x9003"] + "." + other["Exif SubIFD - 0x9291"]);
  EXPECT_EQ(photo->user_comment, other["Exif SubIFD - 0x9286"]);
  EXPECT_EQ(std::to_string(photo->width_px) + " pixels", other["JPEG - 0x0003"]);
  EXPECT_EQ(std::to_string(photo->height_px) + " pixels", other["JPEG - 0x0001"]);
  // The other reader prints these for a person: 0.1 sec, f/3.2, 24 mm, Flash did not fire, 24mm f/2.8.
  EXPECT_EQ(other["Exif SubIFD - 0x829a"], "0.1 sec");
  EXPECT_DOUBLE_EQ(photo->exposure_s.value_or(0), 0.1);
  EXPECT_EQ(other["Exif SubIFD - 0x829d"], "f/3.2");
  EXPECT_DOUBLE_EQ(photo->f_number.value_or(0), 3.2);
  EXPECT_EQ(other["Exif SubIFD - 0x920a"], "24 mm");
  EXPECT_DOUBLE_EQ(photo->focal_length_mm.value_or(0), 24.0);
  EXPECT_EQ(other["Exif SubIFD - 0x9209"], "Flash did not fire");
  EXPECT_EQ(photo->flash_fired, std::optional(false));
  EXPECT_EQ(photo->orientation, std::optional(1));
  EXPECT_THAT(photo->lens, ::testing::HasSubstr("24mm f/2.8"));
  // Exiftool says 0.50 m: byte 68 of the lens' 6 % steps.
  EXPECT_NEAR(photo->focus_distance_m.value_or(0), 0.50, 0.005);
}

TEST(Metadata, TheRealPhotographIsHonestlyUnsuitable) {
  STRIAE_NEED_DATA("nikon_d90");
  const auto photo = ReadMetadata(testing::ReadBytes(testing::TestData("nikon_d90/Nikon D90.jpg")));
  ASSERT_TRUE(photo);
  std::map<std::string, PreflightItem::State> states;
  const auto items = Preflight(*photo, RigRange::kSmall);
  for (const auto& item : items) states[item.name] = item.state;
  using State = PreflightItem::State;
  EXPECT_EQ(states["camera"], State::kOk);
  EXPECT_EQ(states["picture size"], State::kOk);
  EXPECT_EQ(states["ISO"], State::kOk);  // 250
  EXPECT_EQ(states["flash"], State::kFailed);
  EXPECT_EQ(states["focal length"], State::kFailed);  // a 24 mm lens
  EXPECT_EQ(states["exposure time"], State::kWarning);
  EXPECT_EQ(states["aperture"], State::kWarning);
  EXPECT_EQ(states["focus mode"], State::kWarning);  // AF-A
  EXPECT_EQ(states["focus distance"], State::kWarning);
  EXPECT_EQ(Verdict(items), State::kFailed);
}

TEST(Metadata, APracticePhotographSaysWhatItSays) {
  STRIAE_NEED_DATA("practice/wound_0/visit_0.jpg");
  const auto photo = ReadMetadata(testing::ReadBytes(testing::TestData("practice/wound_0/visit_0.jpg")));
  ASSERT_TRUE(photo);
  EXPECT_EQ(photo->model, "NIKON D90");
  EXPECT_DOUBLE_EQ(photo->exposure_s.value_or(0), 1.0 / 200);
  EXPECT_DOUBLE_EQ(photo->f_number.value_or(0), 11);
  EXPECT_EQ(photo->iso, std::optional(400));
  EXPECT_DOUBLE_EQ(photo->focal_length_mm.value_or(0), 50);
  EXPECT_EQ(photo->lens, "AF-S NIKKOR 50mm f/1.8G");
}

TEST(Metadata, EveryFieldThatIsInTheFileIsRead) {
  testing::PhotoOptions taken;
  taken.orientation = 6;
  const auto photo = ReadMetadata(testing::MakeJpeg(taken));
  ASSERT_TRUE(photo);
  EXPECT_EQ(photo->make, "NIKON CORPORATION");
  EXPECT_EQ(photo->lens, "AF NIKKOR 50mm f/1.8D");
  EXPECT_DOUBLE_EQ(photo->exposure_s.value_or(0), 0.005);
  EXPECT_DOUBLE_EQ(photo->f_number.value_or(0), 11);
  EXPECT_EQ(photo->flash_fired, std::optional(true));
  EXPECT_EQ(photo->taken_at_camera_clock, "2026:05:04 07:08:09.12");
  EXPECT_EQ(photo->orientation, std::optional(6));
  EXPECT_EQ(photo->width_px, 4288);  // sensor pixels, whatever the orientation says
  EXPECT_EQ(photo->height_px, 2848);
}

TEST(Metadata, WithoutExifOnlyTheSizeIsKnown) {
  testing::PhotoOptions bare;
  bare.with_exif = false;
  const auto photo = ReadMetadata(testing::MakeJpeg(bare));
  ASSERT_TRUE(photo);
  EXPECT_EQ(photo->width_px, 4288);
  EXPECT_EQ(photo->model, "");
  EXPECT_FALSE(photo->iso || photo->exposure_s || photo->flash_fired || photo->orientation);
  EXPECT_EQ(Verdict(Preflight(*photo, RigRange::kSmall)), PreflightItem::State::kUnknown);
}

TEST(Metadata, AbsurdValuesReadAsAbsent) {
  testing::PhotoOptions absurd;
  absurd.exposure_den = 0;
  absurd.f_number_tenths = 0;
  absurd.orientation = 77;
  const auto photo = ReadMetadata(testing::MakeJpeg(absurd));
  ASSERT_TRUE(photo);
  EXPECT_FALSE(photo->exposure_s || photo->f_number || photo->orientation);
  EXPECT_EQ(photo->iso, std::optional(400));
}

TEST(Metadata, ATruncatedPhotographHasNone) {
  auto bytes = testing::MakeJpeg();
  bytes.resize(bytes.size() / 2);
  const auto photo = ReadMetadata(bytes);
  ASSERT_FALSE(photo);
  EXPECT_EQ(photo.error().code, ErrorCode::kBadImage);
}

TEST(Metadata, ARawFileIsReadToo) {
  const auto photo = ReadMetadata(testing::MakeNef());
  ASSERT_TRUE(photo) << photo.error().Describe();
  EXPECT_EQ(photo->model, "NIKON D90");
  EXPECT_EQ(photo->width_px, 4288);
}

}  // namespace
}  // namespace striae::acquire
