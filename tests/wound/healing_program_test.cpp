// A wound over its visits, as a coordinator asks the record for it.
#include <gmock/gmock.h>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A study with one subject and a wound that is photographed every week while it heals.
class Healing : public ::testing::Test {
 protected:
  static constexpr int kVisits = 5;

  static json Must(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, 0) << ::testing::PrintToString(words) << ": " << ran.err;
    return ran.Json();
  }
  json Do(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    return Must(std::move(words));
  }

  void SetUp() override {
    const fs::path photos = dir_ / "photos";
    Must({"simulate", "limb", "--scale", "0.4", "--crater-radius", "18", "--visits", std::to_string(kVisits), "--out",
          photos.string()});
    truth_ = json::parse(ReadText(photos / "truth.json"));
    Must({"init", study_, "--protocol", "HEAL-1", "--title", "Healing", "--sponsor", "Example Institute", "--site",
          "A"});
    Do({"subject", "add", "S001"});
    Do({"subject", "add", "S002"});
    Do({"consent", "S001", "--given", "2026-01-01"});
    Do({"device", "add", "--serial", "3990001", "--range", "small"});
    Do({"calibration", "add", (photos / truth_.at("calibration").get<std::string>()).string(), "--device", "3990001",
        "--valid-from", "2026-01-01"});
    const char* days[kVisits] = {"2026-01-05", "2026-01-12", "2026-01-19", "2026-01-26", "2026-02-02"};
    for (int k = 0; k < kVisits; ++k) {
      const json& photo = truth_.at("photographs").at(static_cast<std::size_t>(k));
      const std::string session =
          Do({"session", "open", "--subject", "S001", "--visit", "V" + std::to_string(k + 1), "--date", days[k]})
              .at("id");
      const std::string capture = Do({"import", "--session", session,
                                      (photos / photo.at("image").get<std::string>()).string(), "--as", "wound:W1"})
                                      .at("files")
                                      .at(0)
                                      .at("capture");
      Do({"outline", capture, (photos / photo.at("outline").get<std::string>()).string()});
    }
    Do({"process"});
  }

  TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
  json truth_;
};

TEST_F(Healing, OverVisitsIsTheAreasThatWerePhotographed) {
  const json wounds = Do({"healing", "S001", "--wound", "W1"}).at("wounds");
  ASSERT_EQ(wounds.size(), 1U);
  const json& visits = wounds[0].at("visits");
  ASSERT_EQ(visits.size(), static_cast<std::size_t>(kVisits));
  EXPECT_EQ(visits[1].at("day"), 7);
  const auto area = [&](std::size_t k) { return visits[k].at("area_cm2").at("value").get<double>(); };
  for (std::size_t k = 1; k < visits.size(); ++k) {
    const auto par = visits[k].at("percent_area_reduction").at("value").get<double>();
    EXPECT_NEAR(par, 100 * (area(0) - area(k)) / area(0), 1e-6);
    EXPECT_LT(area(k), area(k - 1));  // the simulated wound heals
    EXPECT_GT(visits[k].at("linear_healing_mm").at("value").get<double>(), 0);
    EXPECT_EQ(visits[k].at("area_change").at("verdict"), "improved");
  }
  const json& fit = wounds[0].at("exponential");
  EXPECT_GT(fit.at("rate_per_day").at("value").get<double>(), 0);
  EXPECT_GT(fit.at("r_squared").get<double>(), 0.8);
  // Five areas: a closure, or the reason why none is foretold.
  const json& closure = wounds[0].at("closure");
  EXPECT_TRUE(closure.contains("day") || closure.contains("refused")) << closure;
  if (closure.contains("day")) {
    EXPECT_GT(closure.at("day").get<double>(), 28);
  }
}

TEST_F(Healing, SaysSoWhereNothingWasMeasured) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"S002"}, {"S001", "--wound", "W9"}, {"S404"}}) {
    std::vector<std::string> call = {"-C", study_, "healing"};
    call.insert(call.end(), words.begin(), words.end());
    const Ran ran = Striae(call);
    EXPECT_EQ(ran.exit_code, 1) << ::testing::PrintToString(words);
    EXPECT_EQ(ran.out, "");
    EXPECT_NE(ran.err, "");
  }
}

}  // namespace
}  // namespace striae::testing
