// A simulated photograph shows what geometry says it must: depth, stripes, shadows, exposure, tags.
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <exiv2/exiv2.hpp>
#include <gtest/gtest.h>

#include "acquire/rig/bust.h"
#include "acquire/rig/default_rig.h"
#include "acquire/rig/limb.h"
#include "acquire/rig/photograph_file.h"
#include "acquire/rig/plane.h"
#include "acquire/rig/render.h"

namespace striae::rig {
namespace {

constexpr double kQuarter = 0.25;  // of the sensor's side: 1072 x 712, the carrier at 4.5 px

Calibration SmallRig(double scale) { return ScaleSensor(DefaultRig(Range::kSmall).calibration, scale); }

/// A camera without distortion, so that the test needs no inverse.
Calibration IdealCamera(double scale) {
  Calibration rig = SmallRig(scale);
  rig.camera.k1 = rig.camera.k2 = rig.camera.p1 = rig.camera.p2 = 0;
  return rig;
}

Eigen::Vector3d IdealRay(const CameraModel& camera, double col, double row) {
  return {(col - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1};
}

/// OPTICS' formula, written out here once more.
double Order(const ProjectorModel& p, const Eigen::Vector3d& point) {
  const double angle = p.rotation_rodrigues.norm();
  const Eigen::Vector3d q = Eigen::AngleAxisd(angle, p.rotation_rodrigues / angle) * (point - p.center_mm);
  const double a = q.x() / q.z(), b = q.y() / q.z();
  return p.center_order + p.focal_stripes * b * (1 + p.k1 * (a * a + b * b));
}

TEST(Photograph, DepthIsThePlanes) {
  const Calibration rig = IdealCamera(kQuarter);
  PlaneOptions options;
  options.tilt_x_deg = 7;
  options.tilt_y_deg = -12;
  const auto made = Render(MakePlane(options), rig, {});
  ASSERT_TRUE(made) << made.error().Describe();
  const Eigen::Vector3d normal = PlaneNormal(options);
  for (int row = 5; row < rig.image_height_px; row += 41) {
    for (int col = 5; col < rig.image_width_px; col += 41) {
      const double depth = normal.z() * options.distance_mm / normal.dot(IdealRay(rig.camera, col, row));
      EXPECT_NEAR(made->depth_mm(col, row), depth, 2e-4);  // float32 at 1000 mm holds 6e-5
    }
  }
}

TEST(Photograph, BrightStripesAreCentredOnWholeOrders) {
  const Calibration rig = IdealCamera(0.5);
  RenderOptions render;
  render.sensor.noise = false;
  const auto made = Render(MakePlane({}), rig, render);
  ASSERT_TRUE(made);
  int stripes = 0;
  for (int col = 700; col < 1400; col += 93) {
    std::complex<double> sum = 0;
    for (int row = 300; row < 1100; ++row) {
      const double n = Order(rig.projector, 1000 * IdealRay(rig.camera, col, row));
      sum += static_cast<double>(made->photograph(col, row).g) * std::polar(1.0, -2 * std::numbers::pi * n);
      ++stripes;
    }
    // 800 rows, 8-bit steps: the phase of the fundamental is known to far better than a hundredth of a stripe; the
    // bound is a tenth of OPTICS' smallest error of interest (0.03 stripe = 0.5 mm).
    EXPECT_NEAR(std::arg(sum) / (2 * std::numbers::pi), 0, 0.003) << "column " << col;
    EXPECT_GT(std::abs(sum) / 800, 20) << "the stripes have contrast";
  }
}

TEST(Photograph, TheLightEndsWhereTheGratingEnds) {
  const Calibration rig = IdealCamera(kQuarter);
  const auto made = Render(MakePlane({}), rig, {});
  ASSERT_TRUE(made);
  const int col = rig.image_width_px / 2;
  for (int row = 0; row < rig.image_height_px; ++row) {
    const double n = Order(rig.projector, 1000 * IdealRay(rig.camera, col, row));
    EXPECT_EQ(made->lit(col, row) != 0, n > -0.25 && n < *rig.stripes - 0.75) << "order " << n;
    if (n < -1 || n > *rig.stripes) {
      EXPECT_LT(made->photograph(col, row).g, 60) << "ambient light alone";
    }
  }
}

TEST(Photograph, WhatStandsBeforeAWallCastsItsShadowAwayFromTheProjector) {
  const Calibration rig = IdealCamera(kQuarter);
  TriangleMesh scene = MakePlane({});
  PlaneOptions card;
  card.distance_mm = 900;
  card.half_size_mm = 30;
  Append(MakePlane(card), scene);
  const auto made = Render(scene, rig, {});
  ASSERT_TRUE(made);
  // The shadow of the card's lower edge (y = 30 at 900 mm) on the wall, from the projector's centre.
  const Eigen::Vector3d& light = rig.projector.center_mm;
  const double factor = (1000 - light.z()) / (900 - light.z());
  const double shadow_end = light.y() + factor * (30 - light.y()), hidden_end = 30.0 * 1000 / 900;
  ASSERT_GT(shadow_end, hidden_end + 5) << "part of the shadow shows below the card";
  const auto row_of = [&](double y) { return static_cast<int>(std::lround(rig.camera.cy + rig.camera.fy * y / 1000)); };
  const int col = static_cast<int>(rig.camera.cx);
  for (int row = row_of(hidden_end) + 3; row < row_of(shadow_end) - 3; ++row) {
    EXPECT_EQ(made->lit(col, row), 0);
    EXPECT_NEAR(made->depth_mm(col, row), 1000, 0.01);
    EXPECT_LT(made->photograph(col, row).g, 60);
  }
  EXPECT_EQ(made->lit(col, row_of(shadow_end) + 3), 1);
}

TEST(Photograph, SkinIsWellExposedAndTheBackgroundBlack) {
  const auto limb = MakeLimb({});
  ASSERT_TRUE(limb);
  const auto small = Render(limb->mesh, SmallRig(kQuarter), {});
  RenderOptions far;
  far.light.reference_mm = 2000;
  const auto large = Render(MakeBust({}), ScaleSensor(DefaultRig(Range::kLarge).calibration, kQuarter), far);
  ASSERT_TRUE(small && large);
  for (const Rendering* made : {&*small, &*large}) {
    int saturated = 0, bright = 0, lit = 0, background = 0, black = 0;
    for (std::size_t i = 0; i < made->photograph.size(); ++i) {
      const Rgb8 p = made->photograph.pixels()[i];
      saturated += p.r == 255;
      lit += made->lit.pixels()[i];
      bright += made->lit.pixels()[i] != 0 && p.r > 150;
      const bool nothing = std::isnan(made->depth_mm.pixels()[i]);
      background += nothing;
      black += nothing && p.r < 25;
    }
    EXPECT_EQ(saturated, 0);
    EXPECT_GT(bright, 0.25 * lit);  // bright stripes are half of the lit skin
    EXPECT_GT(lit, 50000);
    EXPECT_GT(black, 0.99 * background);  // but for the lens blur at silhouettes
  }
}

TEST(Photograph, SameBytesForAnyNumberOfThreadsAndOtherNoiseForAnotherSeed) {
  const TriangleMesh plane = MakePlane({});
  const Calibration rig = SmallRig(0.1);
  RenderOptions one, two, other;
  one.threads = 1;
  two.threads = 2;
  other.sensor.seed = 2;
  const auto a = Render(plane, rig, one), b = Render(plane, rig, two), c = Render(plane, rig, other);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->photograph.pixels(), b->photograph.pixels());
  EXPECT_EQ(a->lit.pixels(), b->lit.pixels());
  EXPECT_EQ(a->depth_mm.pixels(), b->depth_mm.pixels());  // no NaN here: the plane fills the field
  EXPECT_NE(a->photograph.pixels(), c->photograph.pixels());
  EXPECT_EQ(*EncodeJpeg(a->photograph, {}), *EncodeJpeg(b->photograph, {}));
}

TEST(Photograph, NoiseFollowsTheSensorSpeed) {
  const Calibration rig = SmallRig(kQuarter);
  const auto deviation = [&](double iso) {
    RenderOptions noisy, clean;
    noisy.sensor.iso = iso;
    clean.sensor.noise = false;
    const auto a = Render(MakePlane({}), rig, noisy), b = Render(MakePlane({}), rig, clean);
    double sum = 0;
    for (std::size_t i = 0; i < a->photograph.size(); ++i) {
      sum += std::pow(a->photograph.pixels()[i].g - b->photograph.pixels()[i].g, 2);
    }
    return std::sqrt(sum / static_cast<double>(a->photograph.size()));
  };
  // Shot noise: four times the speed is twice the deviation; 8-bit steps and the sRGB curve blur that.
  EXPECT_NEAR(deviation(6400) / deviation(1600), 2, 0.3);
}

TEST(Photograph, RefusesWhatCannotBeMeant) {
  EXPECT_EQ(Render({}, SmallRig(0.1), {}).error().code, ErrorCode::kUsage);
  RenderOptions dark;
  dark.sensor.iso = 0;
  EXPECT_EQ(Render(MakePlane({}), SmallRig(0.1), dark).error().code, ErrorCode::kUsage);
  CameraTags tags;
  tags.orientation = 9;
  EXPECT_EQ(EncodeJpeg(ImageRgb(8, 8), tags).error().code, ErrorCode::kUsage);
  EXPECT_EQ(EncodeJpeg(ImageRgb(), {}).error().code, ErrorCode::kUsage);
}

TEST(PhotographFile, CarriesTheTagsOfAD90) {
  CameraTags tags;
  tags.serial = "3991234";
  tags.orientation = 6;
  const auto jpeg = EncodeJpeg(ImageRgb(64, 48, Rgb8{90, 80, 70}), tags);
  ASSERT_TRUE(jpeg) << jpeg.error().Describe();
  auto image = Exiv2::ImageFactory::open(jpeg->data(), static_cast<long>(jpeg->size()));
  image->readMetadata();
  Exiv2::ExifData& exif = image->exifData();
  EXPECT_EQ(exif["Exif.Image.Make"].toString(), "NIKON CORPORATION");
  EXPECT_EQ(exif["Exif.Image.Model"].toString(), "NIKON D90");
  EXPECT_EQ(exif["Exif.Image.Orientation"].toLong(), 6);
  EXPECT_EQ(exif["Exif.Photo.ExposureTime"].toString(), "1/200");
  EXPECT_EQ(exif["Exif.Photo.FNumber"].toString(), "11/1");
  EXPECT_EQ(exif["Exif.Photo.ISOSpeedRatings"].toLong(), 400);
  EXPECT_EQ(exif["Exif.Photo.FocalLength"].toString(), "50/1");
  EXPECT_EQ(exif["Exif.Photo.Flash"].toLong() & 1, 1) << "fired";
  EXPECT_EQ(exif["Exif.Nikon3.SerialNumber"].toString(), "3991234");
  EXPECT_EQ(exif["Exif.NikonLd3.FocusDistance"].toLong(), 80) << "0.01 m 10^(80 / 40) = 1 m, decrypted";
  EXPECT_EQ(image->pixelWidth(), 64);
}

}  // namespace
}  // namespace striae::rig
