// A calibration file of any bytes: never a crash, never a number that is none; a refusal is printable and says what.
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/calibration.h"
#include "core/optics.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const char* const kPinhole = R"({"format":"striae-calibration/1","image_size":[400,300],
  "camera":{"fx":900.5,"fy":901,"cx":199.5,"cy":149.5,"k1":-0.05,"k2":0.04,"p1":0.001,"p2":-0.002},
  "projector":{"model":"pinhole","center_mm":[1,-120,40],"rotation_rodrigues":[0.12,0.01,-0.02],"focal_stripes":500,"center_order":69.5,"k1":-0.03},
  "grating":{"stripes":140,"direction":"horizontal"},"working_distance_mm":[850,1150],"quality":{"sd_mm":0.04,"photographs":9},
  "sources":[{"sha256":"00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff","position_mm":25}],
  "uncertainty":{"names":["camera.fx","projector.center_y"],"covariance":[[4,-0.5],[-0.5,0.09]]}})";
const char* const kAngular = R"({"format":"striae-calibration/1","image_size":[400,300],
  "camera":{"fx":900.5,"fy":901,"cx":199.5,"cy":149.5},
  "projector":{"model":"angular","center_mm":[1,-120,40],"a0_rad":-0.01,"delta_a_rad":0.0019},
  "grating":{"stripes":null,"direction":"vertical"},"working_distance_mm":[850,1150]})";

/// What every reader of a calibration may rely on.
void ReadAnything(const std::string& text) {
  auto calibration = CalibrationFromJson(text);
  if (!calibration) {
    EXPECT_EQ(calibration.error().code, ErrorCode::kBadCalibration);
    EXPECT_THAT(calibration.error().message, HasSubstr("not a usable calibration: "));
    for (const char c : calibration.error().message) EXPECT_TRUE(c >= 0x20 && c <= 0x7e) << static_cast<int>(c);
    return;
  }
  EXPECT_GT(calibration->image_width_px, 0);
  EXPECT_LT(calibration->near_mm, calibration->far_mm);
  for (const char* name : {"camera.fx", "camera.fy", "camera.cx", "camera.k1", "camera.p2", "projector.center_y",
                           "projector.focal_stripes", "projector.k1", "projector.delta_a_rad"}) {
    const double* value = CalibrationParameter(*calibration, name);
    EXPECT_TRUE(value == nullptr || std::isfinite(*value)) << name;
  }
  EXPECT_TRUE(!calibration->uncertainty || calibration->uncertainty->covariance.allFinite());
  const StripeOptics optics(*calibration);
  const Eigen::Vector3d ray = RayOf(calibration->camera, {10, 20});  // may be no number for absurd lenses, not a crash
  const auto depth = optics.DepthAt(ray, 30);
  EXPECT_TRUE(!depth || (std::isfinite(*depth) && *depth > 0));
  EXPECT_TRUE(CalibrationFromJson(ToJsonText(*calibration)));
}

TEST(CalibrationFuzz, BothSeedsAreWhole) {
  ASSERT_TRUE(CalibrationFromJson(kPinhole)) << CalibrationFromJson(kPinhole).error().message;
  ASSERT_TRUE(CalibrationFromJson(kAngular)) << CalibrationFromJson(kAngular).error().message;
}

TEST(CalibrationFuzz, EveryByteMayBeWrongOrTheLast) {
  for (const std::string seed : {kPinhole, kAngular}) {
    for (std::size_t at = 0; at < seed.size(); ++at) {
      for (const char value : {'\0', '\xff', '9', '-', '"', '{', ']', 'e', '\n'}) {
        std::string changed = seed;
        changed[at] = value;
        ReadAnything(changed);
      }
      ReadAnything(seed.substr(0, at));
    }
  }
}

TEST(CalibrationFuzz, RandomDamage) {
  std::mt19937 random(20261122);  // fixed: the same files every time
  for (const std::string seed : {kPinhole, kAngular}) {
    for (int round = 0; round < 3000; ++round) {
      std::string changed = seed;
      const int edits = 1 + static_cast<int>(random() % 6);
      for (int edit = 0; edit < edits; ++edit) {
        const std::size_t at = random() % changed.size(), from = random() % changed.size();
        if (random() % 2 == 0) {
          changed[at] = static_cast<char>(random());
        } else {
          changed.insert(at, changed.substr(from, random() % 40));
        }
      }
      ReadAnything(changed);
    }
  }
}

/// Every place of the tree, leaves and branches.
void Places(const json& node, const json::json_pointer& here, std::vector<json::json_pointer>& places) {
  places.push_back(here);
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) Places(value, here / key, places);
  }
  for (std::size_t i = 0; node.is_array() && i < node.size(); ++i) Places(node[i], here / i, places);
}

TEST(CalibrationFuzz, EveryFieldMayBeAnything) {
  const std::vector<json> nonsense = {nullptr,
                                      true,
                                      "",
                                      "NaN",
                                      -1,
                                      0,
                                      1e-300,
                                      1e8,
                                      1e300,
                                      -1e300,
                                      json::array(),
                                      json::object(),
                                      {1, 2, 3},
                                      {{"x", 1}},
                                      18446744073709551615ULL};
  for (const char* seed : {kPinhole, kAngular}) {
    const json whole = json::parse(seed);
    std::vector<json::json_pointer> places;
    Places(whole, json::json_pointer(), places);
    for (const auto& place : places) {
      for (const json& value : nonsense) {
        json changed = whole;
        changed[place] = value;
        ReadAnything(changed.dump());
      }
      if (place.empty()) continue;
      json without = whole;
      json& parent = without[place.parent_pointer()];
      if (parent.is_object()) parent.erase(place.back());
      ReadAnything(without.dump());
    }
  }
}

TEST(CalibrationFuzz, RefusesWhatJsonAllowsAndNobodyMeans) {
  const std::string text = kPinhole;
  const auto refusal = [](const std::string& bytes) {
    const auto calibration = CalibrationFromJson(bytes);
    return calibration ? std::string("accepted") : calibration.error().message;
  };
  std::string twice = text;
  twice.insert(twice.find("\"fy\""), "\"fx\":1200,");
  EXPECT_THAT(refusal(twice), HasSubstr("\"fx\" stands twice"));
  for (const int levels : {20, 100000}) {
    std::string nested = text;
    const auto repeat = [&](const char* what) {
      std::string all;
      for (int i = 0; i < levels; ++i) all += what;
      return all;
    };
    nested.insert(1, "\"note\":" + repeat("[") + repeat("]") + ",");
    EXPECT_THAT(refusal(nested), HasSubstr("nested too deeply"));
    EXPECT_THAT(refusal(repeat("[")), HasSubstr("not a usable calibration"));
  }
  std::string overflow = text;
  overflow.replace(overflow.find("900.5"), 5, "1e999");
  EXPECT_THAT(refusal(overflow), HasSubstr("not a usable calibration"));
  EXPECT_THAT(refusal(std::string(17 << 20, ' ')), HasSubstr("16 MB"));
}

}  // namespace
}  // namespace striae
