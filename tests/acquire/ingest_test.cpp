#include "acquire/ingest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/preflight.h"
#include "tests/support/ids.h"
#include "tests/support/ptp_photo.h"

namespace striae::acquire {
namespace {

using testing::SomeId;

IngestItem Photograph(std::vector<std::uint8_t> bytes) {
  CaptureBinding binding;
  binding.subject = SomeId<SubjectId>(1);
  binding.session = SomeId<SessionId>(2);
  binding.role = {CaptureRole::Kind::kWound, "W1"};
  binding.body_site = "calf";
  binding.laterality = Laterality::kLeft;
  return {std::move(bytes), "DSC_0001.JPG", "card/DSC_0001.JPG", binding};
}

TEST(Ingest, AWholePhotographBecomesACaptureOfItsSession) {
  const auto item = Photograph(testing::MakeJpeg());
  const auto capture = Ingest(item, {SomeId<CaptureId>(3), RigRange::kSmall});
  ASSERT_TRUE(capture) << capture.error().Describe();
  EXPECT_EQ(capture->id, SomeId<CaptureId>(3));
  EXPECT_EQ(capture->session, SomeId<SessionId>(2));
  EXPECT_EQ(capture->role.ToString(), "wound:W1");
  EXPECT_EQ(capture->body_site, "calf");
  EXPECT_EQ(capture->laterality, Laterality::kLeft);
  EXPECT_EQ(capture->file_name, "DSC_0001.JPG");
  EXPECT_EQ(capture->media_type, "image/jpeg");
  EXPECT_EQ(capture->size_bytes, item.bytes.size());
  EXPECT_EQ(capture->metadata.iso, std::optional(400));
  // Focus mode and distance stand in Nikon's own tags, which this file lacks: not known is not good.
  EXPECT_EQ(Verdict(capture->preflight), PreflightItem::State::kUnknown);
}

TEST(Ingest, TakenBadlyIsStillTakenWithItsVerdict) {
  testing::PhotoOptions dark;
  dark.flash = 0;
  const auto capture = Ingest(Photograph(testing::MakeJpeg(dark)), {});
  ASSERT_TRUE(capture);
  EXPECT_EQ(Verdict(capture->preflight), PreflightItem::State::kFailed);
}

TEST(Ingest, WhatBelongsToNobodyIsRefused) {
  auto item = Photograph(testing::MakeJpeg());
  item.binding.reset();
  const auto capture = Ingest(item, {});
  ASSERT_FALSE(capture);
  EXPECT_EQ(capture.error().code, ErrorCode::kRecordRefused);
}

TEST(Ingest, ATruncatedFileIsRefusedByName) {
  auto item = Photograph(testing::MakeJpeg());
  item.bytes.resize(item.bytes.size() - 5);
  const auto capture = Ingest(item, {});
  ASSERT_FALSE(capture);
  EXPECT_EQ(capture.error().code, ErrorCode::kBadImage);
  EXPECT_THAT(capture.error().Describe(), ::testing::HasSubstr("card/DSC_0001.JPG"));
}

TEST(Ingest, BytesBehindThePictureAreReported) {
  auto item = Photograph(testing::MakeJpeg());
  item.bytes.resize(item.bytes.size() + 100, 0);
  const auto capture = Ingest(item, {});
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->preflight.back().name, "file end");
  EXPECT_EQ(capture->preflight.back().state, PreflightItem::State::kWarning);
}

}  // namespace
}  // namespace striae::acquire
