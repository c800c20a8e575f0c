#include "core/measurement.h"

#include <limits>

#include <gmock/gmock.h>

namespace striae {
namespace {

AnalysisReport InventedReport() {
  AnalysisReport report;
  report.analysis = "wound";
  report.version = "1";
  report.provenance.version = "0.1.0";
  report.provenance.inputs = {{"surface", Sha256{}}};
  report.provenance.parameters = {{"ring_mm", 12}};
  Measurement volume{"volume", {"SCT", "118565006", "Volume"}, {{"LN", "94083-3", "Wound volume"}}, 8.31, "mL", 0.12};
  Measurement depth{"depth_max", {"SCT", "131197000", "Depth"}, {},          9.2, "mm",
                    0.4,         Measurement::Status::kFlagged, "steep wall"};
  report.measurements = {volume, depth};
  report.details = {{"axes_source", "camera"}};
  return report;
}

TEST(AnalysisReport, HasTheContractsFields) {
  const auto json = ToJson(InventedReport());
  EXPECT_EQ(json.at("analysis"), "wound");
  EXPECT_EQ(json.at("inputs").at(0).at("sha256"), std::string(64, '0'));
  const auto& volume = json.at("measurements").at(0);
  EXPECT_EQ(volume.at("name"), "volume");
  EXPECT_EQ(volume.at("unit"), "mL");
  EXPECT_EQ(volume.at("status"), "ok");
  EXPECT_EQ(volume.at("code").at("value"), "118565006");
  EXPECT_FALSE(volume.contains("reason"));
  EXPECT_EQ(json.at("measurements").at(1).at("reason"), "steep wall");
  EXPECT_EQ(json.at("axes_source"), "camera");
}

TEST(AnalysisReport, SurvivesWritingAndReading) {
  const auto json = ToJson(InventedReport());
  const auto back = AnalysisReportFromJson(json);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(ToJson(*back), json);
  EXPECT_EQ(back->Find("depth_max")->status, Measurement::Status::kFlagged);
  EXPECT_EQ(back->Find("rotation"), nullptr);
}

TEST(AnalysisReport, RefusesNumbersThatAreNone) {
  auto json = ToJson(InventedReport());
  json["measurements"][0]["value"] = nullptr;  // what NaN becomes in JSON
  EXPECT_FALSE(AnalysisReportFromJson(json));
  json["measurements"][0]["value"] = 1.0;
  json["measurements"][0]["uncertainty"] = -1.0;
  EXPECT_FALSE(AnalysisReportFromJson(json));
  json.erase("measurements");
  EXPECT_FALSE(AnalysisReportFromJson(json));
}

}  // namespace
}  // namespace striae
