#include "acquire/preflight.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace striae::acquire {
namespace {

using State = PreflightItem::State;

PhotoMetadata AsTheMethodAsks() {
  PhotoMetadata photo;
  photo.make = "NIKON CORPORATION";
  photo.model = "NIKON D90";
  photo.exposure_s = 1.0 / 200;
  photo.f_number = 11;
  photo.iso = 400;
  photo.focal_length_mm = 50;
  photo.focus_distance_m = 1.0;
  photo.flash_fired = true;
  photo.focus_mode = "MANUAL";
  photo.width_px = 4288;
  photo.height_px = 2848;
  return photo;
}

PreflightItem ItemOf(const PhotoMetadata& photo, const std::string& name, RigRange range = RigRange::kSmall) {
  for (const auto& item : Preflight(photo, range)) {
    if (item.name == name) return item;
  }
  ADD_FAILURE() << "no item " << name;
  return {};
}

TEST(Preflight, APhotographTakenAsAskedPasses) {
  const auto items = Preflight(AsTheMethodAsks(), RigRange::kSmall);
  EXPECT_EQ(Verdict(items), State::kOk);
  for (const auto& item : items) EXPECT_TRUE(item.advice.empty()) << item.name;
}

TEST(Preflight, WithoutFlashThereAreNoStripes) {
  auto photo = AsTheMethodAsks();
  photo.flash_fired = false;
  const auto item = ItemOf(photo, "flash");
  EXPECT_EQ(item.state, State::kFailed);
  EXPECT_EQ(item.found, "did not fire");
  EXPECT_THAT(item.advice, ::testing::HasSubstr("open the flash"));
}

TEST(Preflight, AnotherLensOrPictureSizeBreaksTheCalibration) {
  auto photo = AsTheMethodAsks();
  photo.focal_length_mm = 24;
  EXPECT_EQ(ItemOf(photo, "focal length").state, State::kFailed);
  photo = AsTheMethodAsks();
  photo.width_px = 2144;
  photo.height_px = 1424;
  EXPECT_EQ(ItemOf(photo, "picture size").state, State::kFailed);
  photo = AsTheMethodAsks();
  std::swap(photo.width_px, photo.height_px);  // turned by a program: the geometry lives in sensor pixels
  EXPECT_EQ(ItemOf(photo, "picture size").state, State::kFailed);
}

TEST(Preflight, ExposureMayBeRoundedButNotAStepOff) {
  auto photo = AsTheMethodAsks();
  for (const auto& [seconds, state] : {std::pair(0.005, State::kOk), std::pair(1.0 / 160, State::kWarning),
                                       std::pair(1.0 / 250, State::kWarning), std::pair(0.1, State::kWarning)}) {
    photo.exposure_s = seconds;
    EXPECT_EQ(ItemOf(photo, "exposure time").state, state) << seconds;
  }
}

TEST(Preflight, IsoMayBeFrom200To500) {
  auto photo = AsTheMethodAsks();
  for (const auto& [iso, state] : {std::pair(199, State::kWarning), std::pair(200, State::kOk),
                                   std::pair(500, State::kOk), std::pair(501, State::kWarning)}) {
    photo.iso = iso;
    EXPECT_EQ(ItemOf(photo, "ISO").state, state) << iso;
  }
}

TEST(Preflight, TheFocusMarkDependsOnTheRange) {
  auto photo = AsTheMethodAsks();
  photo.focus_distance_m = 2.0;
  EXPECT_EQ(ItemOf(photo, "focus distance", RigRange::kSmall).state, State::kWarning);
  EXPECT_EQ(ItemOf(photo, "focus distance", RigRange::kLarge).state, State::kOk);
}

TEST(Preflight, WhatTheFileDoesNotSayIsUnknownNotGood) {
  const auto items = Preflight(PhotoMetadata{}, RigRange::kSmall);
  for (const auto& item : items) {
    EXPECT_EQ(item.state, State::kUnknown) << item.name;
    EXPECT_EQ(item.found, "not in the file") << item.name;
  }
  EXPECT_EQ(Verdict(items), State::kUnknown);
}

}  // namespace
}  // namespace striae::acquire
