#include "core/calibration.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/support/test_data.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json SmallRig() {
  return json::parse(R"({"format":"striae-calibration/1","image_size":[400,300],
    "camera":{"fx":900.5,"fy":901,"cx":199.5,"cy":149.5,"k1":-0.05,"k2":0.04,"p1":0.001,"p2":-0.002},
    "projector":{"center_mm":[1,-120,40],"rotation_rodrigues":[0.12,0.01,-0.02],"focal_stripes":500,"center_order":69.5,"k1":-0.03},
    "grating":{"stripes":140,"direction":"horizontal"},"working_distance_mm":[850,1150]})");
}

TEST(Calibration, SurvivesWritingAndReading) {
  const auto first = CalibrationFromJson(SmallRig().dump());
  ASSERT_TRUE(first) << first.error().message;
  const auto second = CalibrationFromJson(ToJsonText(*first));
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(ToJsonText(*first), ToJsonText(*second));
  EXPECT_EQ(second->camera.k2, 0.04);
  EXPECT_EQ(second->projector.center_mm.y(), -120);
  EXPECT_EQ(second->stripes, 140);
}

TEST(Calibration, AHandWrittenFileNeedsNoStripesQualityOrSources) {
  json rig = SmallRig();
  rig["grating"]["stripes"] = nullptr;
  rig["camera"].erase("k1");
  const auto calibration = CalibrationFromJson(rig.dump());
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_FALSE(calibration->stripes.has_value());
  EXPECT_EQ(calibration->camera.k1, 0);
}

TEST(Calibration, ReadsTheAngularModel) {
  json rig = SmallRig();
  rig["projector"] = {{"model", "angular"}, {"center_mm", {0, -120, 40}}, {"a0_rad", -0.1}, {"delta_a_rad", 0.002}};
  const auto calibration = CalibrationFromJson(rig.dump());
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_EQ(calibration->projector.kind, ProjectorModel::Kind::kAngular);
  EXPECT_EQ(calibration->projector.delta_a_rad, 0.002);
}

struct Nonsense {
  const char* pointer;
  json value;
  const char* named;
};

TEST(Calibration, NamesTheFieldThatCannotBe) {
  const Nonsense cases[] = {{"/format", "striae-calibration/9", "/format"},
                            {"/image_size", {0, 300}, "/image_size"},
                            {"/image_size", {400.5, 300}, "/image_size"},
                            {"/camera/fx", -1, "/camera/fx"},
                            {"/camera/cx", "middle", "/camera/cx"},
                            {"/camera/cy", 1e300, "/camera/cy"},
                            {"/projector/focal_stripes", 0, "/projector/focal_stripes"},
                            {"/projector/center_mm", {1, 2}, "/projector/center_mm/2"},
                            {"/projector/model", "magic", "/projector/model"},
                            {"/grating/stripes", 2.5, "/grating/stripes"},
                            {"/grating/direction", "diagonal", "/grating/direction"},
                            {"/working_distance_mm", {1150, 850}, "/working_distance_mm"}};
  for (const auto& [pointer, value, named] : cases) {
    json rig = SmallRig();
    rig[json::json_pointer(pointer)] = value;
    const auto calibration = CalibrationFromJson(rig.dump());
    ASSERT_FALSE(calibration) << pointer << " = " << value;
    EXPECT_EQ(calibration.error().code, ErrorCode::kBadCalibration);
    EXPECT_THAT(calibration.error().message, HasSubstr(named));
  }
}

json SmallRigWithUncertainty() {
  json rig = SmallRig();
  rig["uncertainty"] = {{"names", {"camera.fx", "projector.center_y"}}, {"covariance", {{4.0, -0.5}, {-0.5, 0.09}}}};
  return rig;
}

TEST(Calibration, CarriesTheCovarianceOfItsParameters) {
  const auto first = CalibrationFromJson(SmallRigWithUncertainty().dump());
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_TRUE(first->uncertainty);
  EXPECT_EQ(first->uncertainty->names[1], "projector.center_y");
  EXPECT_EQ(first->uncertainty->covariance(1, 0), -0.5);
  EXPECT_EQ(ToJsonText(*first), ToJsonText(*CalibrationFromJson(ToJsonText(*first))));
  EXPECT_FALSE(CalibrationFromJson(SmallRig().dump())->uncertainty);
}

TEST(Calibration, RefusesACovarianceThatIsNone) {
  const Nonsense cases[] = {{"/uncertainty/covariance", {{4.0, -0.5}}, "one row"},
                            {"/uncertainty/covariance", {{4.0, -0.5}, {-0.5}}, "square"},
                            {"/uncertainty/covariance", {{4.0, -0.5}, {-0.4, 0.09}}, "symmetric"},
                            {"/uncertainty/covariance", {{4.0, -0.5}, {-0.5, -0.09}}, "negative diagonal"},
                            {"/uncertainty/covariance", {{4.0, -0.7}, {-0.7, 0.09}}, "correlation"},
                            {"/uncertainty/covariance", {{4.0, "x"}, {-0.5, 0.09}}, "/uncertainty/covariance/0/1"},
                            {"/uncertainty/names", {"camera.fx", "camera.fx"}, "twice"},
                            {"/uncertainty/names", {"camera.fx", "projector.a0_rad"}, "does not have"},
                            {"/uncertainty", {1, 2}, "at()"}};
  for (const auto& [pointer, value, named] : cases) {
    json rig = SmallRigWithUncertainty();
    rig[json::json_pointer(pointer)] = value;
    const auto calibration = CalibrationFromJson(rig.dump());
    ASSERT_FALSE(calibration) << pointer << " = " << value;
    EXPECT_THAT(calibration.error().message, HasSubstr(named));
  }
}

TEST(Calibration, NamesEachOfItsParameters) {
  auto rig = *CalibrationFromJson(SmallRig().dump());
  *CalibrationParameter(rig, "projector.rotation_z") += 1;
  EXPECT_EQ(rig.projector.rotation_rodrigues.z(), 0.98);
  EXPECT_EQ(CalibrationParameter(rig, "projector.delta_a_rad"), nullptr);  // of the other model
  EXPECT_EQ(CalibrationParameter(rig, "fx"), nullptr);
}

TEST(Calibration, RefusesWhatIsNoJson) {
  for (const char* text : {"", "{", "[]", "null", "{\"format\":\"striae-calibration/1\",\"image_size\":[NaN,1]}"}) {
    EXPECT_FALSE(CalibrationFromJson(text)) << text;
  }
}

TEST(Calibration, ReadsTheFilesOfOtherRigs) {
  STRIAE_NEED_DATA("practice/true_small.json");
  for (const char* name : {"practice/true_small.json", "practice/true_large.json", "david_bust/left.json"}) {
    std::ifstream file(testing::TestData(name));
    std::stringstream text;
    text << file.rdbuf();
    const auto calibration = CalibrationFromJson(text.str());
    ASSERT_TRUE(calibration) << name << ": " << calibration.error().message;
    EXPECT_GT(calibration->projector.focal_stripes, 0) << name;
  }
}

}  // namespace
}  // namespace striae
