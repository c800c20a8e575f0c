// The photograph: the camera's bytes, honest orientation and identity, and what is refused.
#include <algorithm>
#include <string>
#include <string_view>

#include <dcmtk/config/osconfig.h>
// osconfig.h comes first: DCMTK's other headers need it.
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dicom/jpeg.h"
#include "dicom/photo.h"
#include "tests/dicom/samples.h"
#include "tests/dicom/tools.h"
#include "tests/support/temp_dir.h"

namespace striae::dicom::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Bytes = std::vector<std::uint8_t>;

/// The data set as DCMTK reads it back.
class Read {
 public:
  explicit Read(const Object& object) {
    const striae::testing::TempDir folder;
    WriteBytes(folder / "object.dcm", object.bytes);
    EXPECT_TRUE(file_.loadFile((folder / "object.dcm").c_str()).good());
    EXPECT_TRUE(file_.loadAllDataIntoMemory().good());
  }
  std::string Text(const DcmTagKey& tag) {
    OFString text;
    file_.getDataset()->findAndGetOFStringArray(tag, text).good();
    return text.c_str();
  }
  bool Has(const DcmTagKey& tag) { return static_cast<bool>(file_.getDataset()->tagExists(tag)); }
  std::vector<std::string> MethodCodes() {
    std::vector<std::string> codes;
    DcmItem* item = nullptr;
    for (long i = 0; file_.getDataset()->findAndGetSequenceItem(DCM_DeidentificationMethodCodeSequence, item, i).good();
         ++i) {
      OFString value;
      item->findAndGetOFString(DCM_CodeValue, value).good();
      codes.emplace_back(value.c_str());
    }
    return codes;
  }
  /// Fragments of the pixel data, the offset table first.
  std::vector<Bytes> Fragments() {
    DcmElement* element = nullptr;
    file_.getDataset()->findAndGetElement(DCM_PixelData, element).good();
    DcmPixelSequence* sequence = nullptr;
    auto* pixels = dynamic_cast<DcmPixelData*>(element);
    EXPECT_TRUE(pixels->getEncapsulatedRepresentation(EXS_JPEGProcess1, nullptr, sequence).good());
    std::vector<Bytes> fragments;
    for (unsigned long i = 0; i < sequence->card(); ++i) {
      DcmPixelItem* item = nullptr;
      sequence->getItem(item, i).good();
      Uint8* data = nullptr;
      item->getUint8Array(data).good();
      fragments.emplace_back(data, data + item->getLength());
    }
    return fragments;
  }

 private:
  DcmFileFormat file_;
};

TEST(Photo, HoldsTheCamerasOwnBytes) {
  for (const int width_px : {61, 64, 65, 66}) {
    for (const JpegKind kind : {JpegKind::kGrey, JpegKind::kColour422, JpegKind::kColour420, JpegKind::kColour444}) {
      // Secrets of two lengths, so that both an even and an odd number of bytes occurs.
      for (const char* secret : {"x", "xy"}) {
        const Bytes jpeg = MakeJpeg(kind, width_px, 47, secret);
        const auto fragments = Read(EncodePhoto(MakeContext(), MakeWoundCapture(), jpeg, 1).value()).Fragments();
        ASSERT_EQ(fragments.size(), 2U);
        EXPECT_THAT(fragments[0], IsEmpty());
        Bytes expected = jpeg;
        if (expected.size() % 2 != 0) expected.push_back(0);  // DICOM values have an even length
        EXPECT_EQ(fragments[1], expected);
      }
    }
  }
}

TEST(Photo, IsDecodedByDcmtkToThePicture) {
  STRIAE_NEED_TOOL("dcmj2pnm");
  const striae::testing::TempDir folder;
  const Bytes jpeg = MakeJpeg(JpegKind::kGrey);
  WriteBytes(folder / "photo.dcm", EncodePhoto(MakeContext(), MakeWoundCapture(), jpeg, 1).value().bytes);
  const ToolResult decoded =
      RunTool({"dcmj2pnm", "--write-raw-pnm", (folder / "photo.dcm").string(), (folder / "photo.pgm").string()});
  ASSERT_EQ(decoded.exit_code, 0) << decoded.output;
  const Bytes pgm = ReadBytes(folder / "photo.pgm"), truth = DecodeJpeg(jpeg);
  ASSERT_GE(pgm.size(), truth.size());
  // Both are 8-bit grey decoded by two libraries of one lineage with the same integer DCT: no difference is allowed.
  EXPECT_TRUE(std::equal(truth.rbegin(), truth.rend(), pgm.rbegin()));
}

TEST(Photo, SaysWhoAndWhatInAPseudonymousWay) {
  Read photo(EncodePhoto(MakeContext(), MakeWoundCapture(), MakeJpeg(JpegKind::kColour422), 3).value());
  EXPECT_EQ(photo.Text(DCM_PatientID), "S001");
  EXPECT_EQ(photo.Text(DCM_ClinicalTrialSubjectID), "S001");
  EXPECT_EQ(photo.Text(DCM_ClinicalTrialProtocolName), "Celjenje ran s Črtami");
  EXPECT_EQ(photo.Text(DCM_SpecificCharacterSet), "ISO_IR 192");
  EXPECT_EQ(photo.Text(DCM_PatientBirthDate), "");
  EXPECT_EQ(photo.Text(DCM_PatientIdentityRemoved), "YES");
  EXPECT_EQ(photo.Text(DCM_ImageLaterality), "L");
  EXPECT_EQ(photo.Text(DCM_DeviceSerialNumber), "7001234");
  EXPECT_EQ(photo.Text(DCM_InstanceNumber), "3");
  EXPECT_EQ(photo.Text(DCM_StudyDate) + photo.Text(DCM_StudyTime), "20260504070809.123");
  EXPECT_EQ(photo.Text(DCM_TimezoneOffsetFromUTC), "+0000");
  EXPECT_EQ(photo.Text(DCM_RecognizableVisualFeatures), "NO");
}

TEST(Photo, ClaimsAConfidentialityProfileOnlyWhenTheJpegWasCleaned) {
  SessionContext context = MakeContext();
  const Bytes jpeg = MakeJpeg(JpegKind::kColour422, 61, 47, "Test^Subject");
  Read kept(EncodePhoto(context, MakeWoundCapture(), jpeg, 1).value());
  EXPECT_THAT(kept.MethodCodes(), IsEmpty());
  EXPECT_THAT(kept.Text(DCM_DeidentificationMethod), HasSubstr("not cleaned"));
  context.strip_jpeg_metadata = true;
  const Object stripped = EncodePhoto(context, MakeWoundCapture(), jpeg, 1).value();
  EXPECT_THAT(Read(stripped).MethodCodes(), ElementsAre("113100", "113106", "113109"));
  const std::string_view secret = "Test^Subject";
  EXPECT_EQ(std::search(stripped.bytes.begin(), stripped.bytes.end(), secret.begin(), secret.end()),
            stripped.bytes.end());
}

TEST(Photo, OrientationIsStatedWhereTheSubjectFacesTheCamera) {
  struct Case {
    int exif;
    const char* rows_and_columns;
  };
  // Upright, the subject's left is at the right edge. Turned by EXIF 6 (to be rotated clockwise to view), the sensor's
  // rows run from head to feet, its columns towards the subject's right; 8 the other way round.
  for (const Case& c : {Case{1, "L\\F"}, Case{3, "R\\H"}, Case{6, "F\\R"}, Case{8, "H\\L"}, Case{2, ""}}) {
    Capture capture = MakeHeadCapture();
    capture.metadata.orientation = c.exif;
    Read photo(EncodePhoto(MakeContext(), capture, MakeJpeg(JpegKind::kColour422), 1).value());
    EXPECT_EQ(photo.Text(DCM_PatientOrientation), c.rows_and_columns) << c.exif;
    EXPECT_EQ(photo.Text(DCM_RecognizableVisualFeatures), "YES");
  }
  Capture turned_wound = MakeWoundCapture();
  turned_wound.metadata.orientation = 6;
  Read photo(EncodePhoto(MakeContext(), turned_wound, MakeJpeg(JpegKind::kColour422), 1).value());
  EXPECT_EQ(photo.Text(DCM_PatientOrientation), "");
  EXPECT_THAT(photo.Text(DCM_ImageComments), HasSubstr("rotate 90 degrees clockwise"));
}

TEST(Photo, RefusesWhatCannotGoOutUnchanged) {
  const Bytes whole = MakeJpeg(JpegKind::kColour422);
  const Bytes truncated(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2));
  const Bytes png{0x89, 'P', 'N', 'G', 1, 2, 3, 4};
  for (const Bytes& bytes : {MakeJpeg(JpegKind::kProgressive), MakeJpeg(JpegKind::kRgb), truncated, png, Bytes{}}) {
    const auto photo = EncodePhoto(MakeContext(), MakeWoundCapture(), bytes, 1);
    ASSERT_FALSE(photo);
    EXPECT_EQ(photo.error().code, ErrorCode::kBadImage);
    EXPECT_THAT(photo.error().Describe(), HasSubstr("DSC_0001.JPG"));
  }
}

TEST(Photo, RefusesAPseudonymThatDicomWouldReadAsSomethingElse) {
  for (const char* pseudonym : {"", "S\\001", "Test^Subject", "S001 "}) {
    SessionContext context = MakeContext();
    context.subject.pseudonym = pseudonym;
    const auto photo = EncodePhoto(context, MakeWoundCapture(), MakeJpeg(JpegKind::kColour422), 1);
    ASSERT_FALSE(photo);
    EXPECT_EQ(photo.error().code, ErrorCode::kUsage);
  }
}

TEST(Photo, FreeTextCannotBecomeTwoValues) {
  SessionContext context = MakeContext();
  context.study.title = "A\\B\nC " + std::string(100, 'x');
  Read photo(EncodePhoto(context, MakeWoundCapture(), MakeJpeg(JpegKind::kColour422), 1).value());
  EXPECT_EQ(photo.Text(DCM_ClinicalTrialProtocolName), "A/B C " + std::string(58, 'x'));
}

TEST(JpegStream, StrippingLeavesThePixelsAndNothingElse) {
  for (const JpegKind kind : {JpegKind::kGrey, JpegKind::kColour422, JpegKind::kColour420, JpegKind::kColour444}) {
    const std::string_view secret = "Test^Subject";
    Bytes jpeg = MakeJpeg(kind, 61, 47, std::string(secret));
    jpeg.insert(jpeg.end(), secret.begin(), secret.end());  // after the end of the picture
    const auto stripped = StripJpegMetadata(jpeg);
    ASSERT_TRUE(stripped);
    EXPECT_EQ(std::search(stripped->begin(), stripped->end(), secret.begin(), secret.end()), stripped->end());
    EXPECT_EQ(DecodeJpeg(*stripped), DecodeJpeg(jpeg));
  }
}

TEST(JpegStream, EveryTruncationIsRefusedOrComplete) {
  const Bytes jpeg = MakeJpeg(JpegKind::kColour422);
  for (std::size_t length = 0; length < jpeg.size(); ++length) {
    EXPECT_FALSE(InspectJpeg(std::span(jpeg).first(length))) << length;
  }
}

}  // namespace
}  // namespace striae::dicom::testing
