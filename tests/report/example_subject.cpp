#include "tests/report/example_subject.h"

#include "report/picture.h"

namespace striae::testing {
namespace {

using report::CaptureEntry;
using report::SubjectReport;
using report::VisitEntry;

Date Day(const char* text) { return Date::Parse(text).value(); }

SubjectReport Frame() {
  SubjectReport subject;
  subject.study.protocol = "STR-01";
  subject.study.title = "Healing of leg ulcers";
  subject.study.sponsor = "Invented University Hospital";
  subject.site.code = "LJ";
  subject.site.name = "Outpatient clinic 1";
  subject.subject.pseudonym = "S001";
  subject.subject.consent_given = Day("2026-05-01");
  subject.devices = {"NIKON D90 2000123, small range"};
  subject.calibrations = {"from 2026-04-20, sha256 1f2e3d4c5b6a"};
  subject.software_version = "0.1.0";
  subject.generated_at = UtcTime::Parse("2026-06-30T09:08:07Z").value();
  return subject;
}

CaptureEntry MakeCapture(const char* role, const char* file, const char* analysis, std::vector<Measurement> values) {
  CaptureEntry entry;
  entry.capture.role = CaptureRole::Parse(role).value();
  entry.capture.file_name = file;
  if (!values.empty()) {
    AnalysisReport report;
    report.analysis = analysis;
    report.version = "1";
    report.measurements = std::move(values);
    entry.analyses = {report};
  }
  entry.photograph = PlainPng(60, 40, 150);
  entry.depth_map = PlainPng(50, 40, 90);
  return entry;
}

CaptureEntry Wound(double area, double volume, double depth) {
  CaptureEntry entry =
      MakeCapture("wound:W1", "DSC_0001.JPG", "wound",
                  {MakeMeasurement("volume", volume, 0.20, "mL"), MakeMeasurement("area", area, 0.3, "cm2"),
                   MakeMeasurement("depth_max", depth, 0.4, "mm")});
  entry.capture.body_site = "calf";
  entry.capture.laterality = Laterality::kLeft;
  return entry;
}

CaptureEntry Pose(double rotation, double flexion, double tilt, double total) {
  return MakeCapture(
      "pose", "DSC_0102.JPG", "head",
      {MakeMeasurement("rotation", rotation, 1.5, "deg"), MakeMeasurement("flexion", flexion, 1.5, "deg"),
       MakeMeasurement("tilt", tilt, 1.5, "deg"), MakeMeasurement("total_angle", total, 1.5, "deg")});
}

VisitEntry MakeVisit(const char* name, const char* date, std::vector<CaptureEntry> captures) {
  VisitEntry visit;
  visit.name = name;
  visit.date = Day(date);
  visit.captures = std::move(captures);
  return visit;
}

}  // namespace

Measurement MakeMeasurement(const std::string& name, double value, double uncertainty, const std::string& unit) {
  Measurement m;
  m.name = name;
  m.code = {"99STRIAE", name, name};
  m.value = value;
  m.uncertainty = uncertainty;
  m.unit = unit;
  return m;
}

std::vector<std::uint8_t> PlainPng(int width, int height, unsigned char grey) {
  return report::EncodePng(ImageRgb(width, height, {grey, grey, grey})).value();
}

SubjectReport WoundSubject() {
  SubjectReport subject = Frame();
  CaptureEntry flagged = Wound(7.0, 1.9, 5.8);
  Measurement& volume = flagged.analyses[0].measurements[0];
  volume.status = Measurement::Status::kFlagged;
  volume.reason = "no healthy skin along 34 % of the boundary";
  CaptureEntry failed = MakeCapture("wound:W2", "DSC_0033.JPG", "wound", {});
  failed.failure = "the outline leaves the reconstructed skin; draw it again on the photograph";
  failed.depth_map.clear();
  VisitEntry missed = MakeVisit("V4", "2026-06-15", {});
  missed.missing = "The subject was ill.";
  subject.visits = {MakeVisit("V1", "2026-05-04", {Wound(12.0, 4.0, 6.0)}),
                    MakeVisit("V2", "2026-05-18", {Wound(10.5, 3.8, 8.0)}),
                    MakeVisit("V3", "2026-06-01", {flagged, failed}), missed};
  return subject;
}

SubjectReport HeadSubject() {
  SubjectReport subject = Frame();
  subject.study.title = "Posture of the head in dystonia";
  subject.visits = {
      MakeVisit("V1", "2026-05-04", {MakeCapture("neutral", "DSC_0101.JPG", "", {}), Pose(32, -8, 1, 33)}),
      MakeVisit("V2", "2026-07-27", {MakeCapture("neutral", "DSC_0201.JPG", "", {}), Pose(20, -14, 2, 25)})};
  return subject;
}

}  // namespace striae::testing
