// From a number to its photograph and back.
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using nlohmann::json;

TEST(Describe, WalksFromANumberToItsPhotographAndBack) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "photo");
  const auto outline =
      study->AddOutline(CountedId<OutlineId>(), capture.id, {{{1, 1}, {9, 1}, {5, 9}}, {}}, NextStamp());
  AnalysisReport report = WoundReport(capture, 3.5);
  report.provenance.inputs.push_back({"outline", outline->sha256});
  const auto outcome = study->AddReport(CountedId<ReportId>(), capture.id, report, NextStamp());
  const auto rows = *study->Results();

  const json measurement = *study->Describe(rows.front().id.ToString());
  EXPECT_EQ(measurement.at("type"), "measurement");
  EXPECT_EQ(measurement.at("name"), "volume");
  EXPECT_EQ(measurement.at("report").at("subject"), "S001");
  const json& leads_to = measurement.at("report").at("leads_to");
  EXPECT_EQ(leads_to.at(0).at("captures").at(0), capture.id.ToString());
  EXPECT_EQ(leads_to.at(1).at("outlines").at(0), outline->id.ToString());

  const json from_photograph = *study->Describe(capture.sha256.ToString());
  EXPECT_EQ(from_photograph.at("captures").at(0), capture.id.ToString());
  EXPECT_EQ(from_photograph.at("reports").at(0), outcome->id.ToString());
  EXPECT_EQ(from_photograph.at("unaltered"), true);
  const json from_outline = *study->Describe(outline->id.ToString());
  EXPECT_EQ(from_outline.at("reports").at(0), outcome->id.ToString());

  const json of_capture = *study->Describe(capture.id.ToString());
  EXPECT_EQ(of_capture.at("type"), "capture");
  EXPECT_EQ(of_capture.at("outcomes").at(0).at("measurements").at(0).at("value"), 3.5);
  EXPECT_EQ(of_capture.at("outline").at("id"), outline->id.ToString());
}

TEST(Describe, ASessionListsItsCaptures) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture first = study.Import(session, "photo 1", "neutral");
  study.Import(session, "photo 2", "pose");
  const json of_session = *study->Describe(session.id.ToString());
  EXPECT_EQ(of_session.at("subject"), "S001");
  EXPECT_EQ(of_session.at("visit"), "V1");
  ASSERT_EQ(of_session.at("captures").size(), 2U);
  EXPECT_EQ(of_session.at("captures").at(0).at("id"), first.id.ToString());
  EXPECT_EQ(of_session.at("captures").at(0).at("sha256"), first.sha256.ToString());
  EXPECT_EQ(of_session.at("captures").at(0).at("role"), "neutral");
  const json of_subject = *study->Describe("S001");
  EXPECT_EQ(of_subject.at("sessions").at(0).at("session"), session.id.ToString());
}

TEST(Describe, KnowsEveryKindOfThing) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  ASSERT_THAT(study->AddDevice({CountedId<DeviceId>(), "6123456", RigRange::kSmall, "NIKON D90", ""}, NextStamp()),
              IsOk());
  EXPECT_EQ(study->Describe("6123456")->at("type"), "device");
  EXPECT_EQ(study->Describe(session.visit.ToString())->at("name"), "V1");
  EXPECT_EQ(study->Describe(study->GetStudy()->id.ToString())->at("protocol"), "WND-01");
  EXPECT_EQ(study->Describe(study.site().ToString())->at("code"), "LJ");
}

TEST(Describe, TakesTheBeginningOfAnIdWhenItIsLongEnough) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "photo");
  EXPECT_EQ(study->Describe(capture.id.ToString().substr(0, 13))->at("id"), capture.id.ToString());
  EXPECT_THAT(study->Describe(capture.id.ToString().substr(0, 7)), FailsWith(ErrorCode::kNotFound, "first 8"));
}

TEST(Describe, SaysWhatToDoAboutANameThatItDoesNotKnow) {
  SmallStudy study;
  for (const std::string& name : {std::string("S404"), std::string(), std::string("********"), std::string("%"),
                                  CountedUuid().ToString(), std::string(5000, 'a')}) {
    EXPECT_THAT(study->Describe(name), FailsWith(ErrorCode::kNotFound, "pseudonym")) << name;
    EXPECT_THAT(study->History(name), FailsWith(ErrorCode::kNotFound, "pseudonym")) << name;
  }
}

}  // namespace
}  // namespace striae::testing
