#include "core/target.h"

#include <cmath>

#include <gmock/gmock.h>

namespace striae {
namespace {

SessionId Session(const char* text) { return SessionId::Parse(text).value(); }

// Numbers from Python's zlib.crc32 of the same 16 bytes: 169238177 and 557500719.
TEST(Label, NumberIsTheCrc32OfTheSessionsIdModuloThousand) {
  EXPECT_EQ(LabelMarkerId(Session("3f2a91bc-0d4e-4a6b-8c1d-5e6f70819203")), 177);
  EXPECT_EQ(LabelMarkerId(Session("00000000-0000-4000-8000-000000000000")), 719);
}

TEST(Label, CodeIsWhatTheSessionsIdBeginsWith) {
  const Label label = LabelFor(Session("3f2a91bc-0d4e-4a6b-8c1d-5e6f70819203"), 40);
  EXPECT_EQ(label, (Label{177, 40, "3F2A-91BC"}));
}

TEST(Label, CodeIsUnderstoodHoweverItIsTyped) {
  for (const char* typed : {"3F2A-91BC", "3f2a-91bc", "3F2A91BC", "3f2a91bc"}) {
    EXPECT_EQ(DigitsOfSessionCode(typed), "3f2a91bc") << typed;
  }
  for (const char* typed : {"", "3F2A-91B", "3F2A-91BCD", "3F-2A91BC", "3F2A-91BG", "3F2A--91BC", "S001"}) {
    EXPECT_EQ(DigitsOfSessionCode(typed), "") << typed;
  }
}

// Under stripes of period p (2.1 mm at 1 m, 10.4 mm at 2 m) a board's module is read if it is wider than the stripe's
// dark half, so that some of it is always lit; a label's spans a whole stripe, so that it can be averaged over one.
TEST(Targets, ModulesCanBeReadUnderTheStripes) {
  const auto readable = [](double module_mm, double period_mm) { return module_mm > 0.5 * period_mm; };
  EXPECT_TRUE(readable(BoardFor(RigRange::kSmall).marker_mm / 7, 300.0 / 140));
  EXPECT_TRUE(readable(BoardFor(RigRange::kLarge).marker_mm / 7, 700.0 / 67));
  EXPECT_GT(DefaultLabelSideMm(RigRange::kSmall) / 6, 300.0 / 140);
  EXPECT_GT(DefaultLabelSideMm(RigRange::kLarge) / 6, 700.0 / 67);
}

TEST(Board, FitsThePaperWithAMarginThatAPrinterLeaves) {
  const struct {
    RigRange range;
    double paper_width_mm, paper_height_mm;
  } papers[] = {{RigRange::kSmall, 297, 210}, {RigRange::kLarge, 420, 297}};
  for (const auto& paper : papers) {
    const CharucoBoard board = BoardFor(paper.range);
    EXPECT_LE(board.columns * board.square_mm, paper.paper_width_mm - 30);
    EXPECT_LE(board.rows * board.square_mm, paper.paper_height_mm - 30);
    // OpenCV's detector takes two outlines for one where their corners are nearer than 0.05 of the smaller perimeter.
    EXPECT_GT(std::sqrt(2.0) * (board.square_mm - board.marker_mm) / 2, 0.05 * 4 * board.marker_mm);
    EXPECT_LE(board.columns * board.rows / 2, 50) << "markers in " << board.dictionary;
    EXPECT_EQ(board.rows % 2, 1) << "versions of OpenCV disagree on boards with an even number of rows";
  }
}

}  // namespace
}  // namespace striae
