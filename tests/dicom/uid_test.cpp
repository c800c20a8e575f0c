// UIDs: form, stability, and that changed content never keeps one.
#include "dicom/uid.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "dicom/photo.h"
#include "tests/dicom/samples.h"

namespace striae::dicom::testing {
namespace {

TEST(Uid, IsTheUuidAsADecimalNumber) {
  EXPECT_EQ(UidOf(Uuid{}), "2.25.0");
  // The example of ITU-T X.667 and PS3.5 B.2.
  EXPECT_EQ(UidOf(Uuid::Parse("f81d4fae-7dec-11d0-a765-00a0c91e6bf6").value()),
            "2.25.329800735698586629295641978511506172918");
}

TEST(Uid, OfContentDependsOnContentOnly) {
  EXPECT_EQ(UidOfName("a"), UidOfName("a"));
  EXPECT_NE(UidOfName("a"), UidOfName("b"));
  for (int i = 0; i < 100; ++i) EXPECT_LE(UidOfName(std::to_string(i)).size(), 64U);
}

TEST(Uid, TheSameExportTwiceIsTheSameFiles) {
  const ThreeObjects once = MakeObjects(), again = MakeObjects();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(once.All()[i]->reference, again.All()[i]->reference);
    EXPECT_EQ(once.All()[i]->bytes, again.All()[i]->bytes);
  }
}

TEST(Uid, AnyChangeGivesANewInstance) {
  std::set<std::string> seen;
  const auto add = [&](const SessionContext& context, const Capture& capture, int width_px) {
    const auto photo = EncodePhoto(context, capture, MakeJpeg(JpegKind::kColour422, width_px), 1);
    return seen.insert(photo.value().reference.sop_instance_uid).second;
  };
  EXPECT_TRUE(add(MakeContext(), MakeWoundCapture(), 61));
  EXPECT_FALSE(add(MakeContext(), MakeWoundCapture(), 61));
  EXPECT_TRUE(add(MakeContext(), MakeWoundCapture(), 62));
  Capture other_side = MakeWoundCapture();
  other_side.laterality = Laterality::kRight;
  EXPECT_TRUE(add(MakeContext(), other_side, 61));
  SessionContext renamed = MakeContext();
  renamed.subject.pseudonym = "S002";
  EXPECT_TRUE(add(renamed, MakeWoundCapture(), 61));
}

TEST(Uid, ASessionMovedToAnotherSubjectIsAnotherDicomStudy) {
  SessionContext moved = MakeContext();
  moved.subject.id = SubjectId(Uuid::Parse("f81d4fae-7dec-11d0-a765-00a0c91e6bf6").value());
  EXPECT_NE(StudyUid(MakeContext()), StudyUid(moved));
  EXPECT_NE(PhotoSeriesUid(MakeContext()), PhotoSeriesUid(moved));
}

TEST(Uid, NoTwoCapturesShareAFrameOfReference) {
  const SessionContext context = MakeContext();
  EXPECT_NE(FrameOfReferenceUid(context, MakeWoundCapture().id), FrameOfReferenceUid(context, MakeHeadCapture().id));
  EXPECT_NE(SurfaceSeriesUid(context, MakeWoundCapture().id), SurfaceSeriesUid(context, MakeHeadCapture().id));
}

}  // namespace
}  // namespace striae::dicom::testing
