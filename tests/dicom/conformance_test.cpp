// The three objects before the judges that hospitals use: dciodvfy, dcentvfy (dicom3tools), dsrdump, dcmdump (DCMTK).
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dicom/photo.h"
#include "tests/dicom/samples.h"
#include "tests/dicom/tools.h"
#include "tests/support/temp_dir.h"

namespace striae::dicom::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string Put(const striae::testing::TempDir& folder, const Object& object) {
  const auto path = folder / (std::string(ToString(object.reference.kind)) + ".dcm");
  WriteBytes(path, object.bytes);
  return path.string();
}

std::vector<std::string> LinesWith(const std::string& text, const std::string& word) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.find(word) != std::string::npos) lines.push_back(line);
  }
  return lines;
}

/// dciodvfy finds no error; its warnings are only about the declared scheme of our own codes, which it cannot know.
void ExpectConforming(const std::string& path) {
  const ToolResult verdict = RunTool({"dciodvfy", "-new", path});
  EXPECT_EQ(verdict.exit_code, 0) << verdict.output;
  EXPECT_THAT(LinesWith(verdict.output, "Error"), IsEmpty());
  for (const std::string& warning : LinesWith(verdict.output, "Warning")) {
    EXPECT_THAT(warning, HasSubstr("CodingScheme"));
    EXPECT_THAT(warning, HasSubstr("Unrecognized defined term"));
  }
}

TEST(Conformance, DciodvfyFindsNoErrorInAnyOfTheThreeObjects) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  const ThreeObjects objects = MakeObjects();
  for (const Object* object : objects.All()) {
    SCOPED_TRACE(ToString(object->reference.kind));
    ExpectConforming(Put(folder, *object));
  }
}

TEST(Conformance, DciodvfyFindsNoErrorInStrippedObjectsEither) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  SessionContext context = MakeContext();
  context.strip_jpeg_metadata = true;
  const ThreeObjects objects = MakeObjects(context);
  for (const Object* object : objects.All()) {
    SCOPED_TRACE(ToString(object->reference.kind));
    ExpectConforming(Put(folder, *object));
  }
}

TEST(Conformance, DciodvfyFindsNoErrorInPhotographsOfEveryColourAndKnowledge) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  Capture nothing_known = MakeWoundCapture();
  nothing_known.role = {};
  nothing_known.body_site.clear();
  nothing_known.laterality = Laterality::kUnspecified;
  nothing_known.metadata = {};
  Capture unlisted_site = MakeWoundCapture();
  unlisted_site.body_site = "stump of the left thigh";
  for (const Capture& capture : {MakeWoundCapture(), MakeHeadCapture(), nothing_known, unlisted_site}) {
    for (const JpegKind kind : {JpegKind::kGrey, JpegKind::kColour422, JpegKind::kColour420, JpegKind::kColour444}) {
      SCOPED_TRACE(capture.role.ToString() + " " + std::to_string(static_cast<int>(kind)));
      ExpectConforming(Put(folder, EncodePhoto(MakeContext(), capture, MakeJpeg(kind), 1).value()));
    }
  }
}

TEST(Conformance, AStudyWithoutSiteNameAndSerialStillConforms) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  SessionContext context = MakeContext();
  context.site = {};
  context.device = {};
  context.study.title.clear();
  context.study.coordinating_centre.clear();
  const ThreeObjects objects = MakeObjects(context);
  for (const Object* object : objects.All()) {
    SCOPED_TRACE(ToString(object->reference.kind));
    ExpectConforming(Put(folder, *object));
  }
}

TEST(Conformance, AHeadReportConforms) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  const SessionContext context = MakeContext();
  const Object photo = EncodePhoto(context, MakeHeadCapture(), MakeJpeg(JpegKind::kColour422), 1).value();
  // The neutral pose was taken at an earlier session.
  SessionContext earlier = context;
  earlier.session.id = SessionId(Uuid::Parse("f81d4fae-7dec-11d0-a765-00a0c91e6bf6").value());
  const Object neutral = EncodePhoto(earlier, MakeWoundCapture(), MakeJpeg(JpegKind::kColour422), 1).value();
  const MeasurementGroup group{
      MakeHeadCapture(), MakeHeadReport(), context.session.opened_at, {photo.reference, neutral.reference}};
  ExpectConforming(Put(folder, EncodeMeasurements(context, {group}, 1).value()));
}

TEST(Conformance, DcentvfyFindsTheObjectsAgreeAboutPatientStudyAndSeries) {
  STRIAE_NEED_TOOL("dcentvfy");
  const striae::testing::TempDir folder;
  const ThreeObjects objects = MakeObjects();
  const ToolResult verdict = RunTool(
      {"dcentvfy", Put(folder, objects.photo), Put(folder, objects.surface), Put(folder, objects.measurements)});
  EXPECT_EQ(verdict.exit_code, 0);
  // dcentvfy counts Accession Number to the series of a photograph (through its request attributes) and to the study
  // of a report: that is about its tables, not about our values. Anything else would be a disagreement.
  for (const std::string& warning : LinesWith(verdict.output, " - ")) {
    EXPECT_THAT(warning, HasSubstr("Different information entities for attribute - Element=<AccessionNumber>"));
  }
}

TEST(Conformance, DsrdumpReadsTheReportAndFindsItsTemplates) {
  STRIAE_NEED_TOOL("dsrdump");
  const striae::testing::TempDir folder;
  const ToolResult dump = RunTool({"dsrdump", "+Pt", "+Pc", "+Pl", "+U8", Put(folder, MakeObjects().measurements)});
  EXPECT_EQ(dump.exit_code, 0);
  for (const char* expected :
       {"Comprehensive 3D SR Document", "# TID 1500 (DCMR)", "# TID 1501 (DCMR)",
        "(121058,DCM,\"Procedure reported\")=(363679005,SCT,", "(121071,DCM,\"Finding\")=(416462003,SCT,\"Wound\")",
        "(363698007,SCT,\"Finding Site\")=(53840002,SCT,\"Calf of leg\")",
        "(272741003,SCT,\"Laterality\")=(7771000,SCT,\"Left\")",
        "NUM:(118565006,SCT,\"Volume\")=\"12.3456789012346\" (mL,UCUM,\"milliliter\")",
        "(121050,DCM,\"Equivalent Meaning of Concept Name\")=(94083-3,LN,\"Wound volume\")",
        "inferred from NUM:(371884006,SCT,\"+/-, range of measurement uncertainty\")=\"0.4\" (mL,UCUM,",
        "(111001,DCM,\"Algorithm Name\")=\"Striae wound/volume\"",
        "(111003,DCM,\"Algorithm Version\")=\"1 (Striae 0.1.0)\"",
        "inferred from IMAGE:(121112,DCM,\"Source of Measurement\")=(VLp image,)",
        "inferred from COMPOSITE:(121112,DCM,\"Source of Measurement\")=(EncapsulatedSTLStorage,)",
        "(121106,DCM,\"Comment\")=\"Flagged: steep wall seen by no stripe\""}) {
    EXPECT_THAT(dump.output, HasSubstr(expected));
  }
}

TEST(Conformance, DcmdumpReadsEveryObjectWithoutAWord) {
  STRIAE_NEED_TOOL("dcmdump");
  const striae::testing::TempDir folder;
  const ThreeObjects objects = MakeObjects();
  for (const Object* object : objects.All()) {
    const ToolResult dump = RunTool({"dcmdump", "-E", Put(folder, *object)});
    EXPECT_EQ(dump.exit_code, 0);
    EXPECT_THAT(dump.output, HasSubstr("[" + object->reference.sop_instance_uid + "]"));
    EXPECT_THAT(dump.output, HasSubstr("[ISO_IR 192]"));
    EXPECT_THAT(dump.output, Not(HasSubstr("?")));  // as dcmdump shows a VR or a tag it does not know
  }
}

}  // namespace
}  // namespace striae::dicom::testing
