// Printed targets: rendered as a printer would and read back with OpenCV. The exact size is the test.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "report/print/targets.h"
#include "tests/support/program.h"
#include "tests/support/temp_dir.h"

namespace striae::report {
namespace {

constexpr UtcTime kMadeAt{1'777'880'000'000};
constexpr double kMmPerInch = 25.4;

#define STRIAE_NEED_POPPLER()                                                             \
  if (!testing::OnPath("pdftoppm")) GTEST_SKIP() << "no pdftoppm: install poppler-utils"; \
  static_assert(true)

/// The pages of a PDF as grey pictures of `dpi` pixels an inch.
std::vector<cv::Mat1b> Pages(const std::vector<std::uint8_t>& pdf, double dpi) {
  const testing::TempDir dir;
  const std::string file = (dir / "print.pdf").string();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(pdf.data()), static_cast<std::streamsize>(pdf.size()));
  testing::RunProgram("pdftoppm", {"-png", "-gray", "-r", std::to_string(dpi), file, (dir / "page").string()});
  std::vector<cv::Mat1b> pages;
  for (int page = 1;; ++page) {
    const cv::Mat picture =
        cv::imread((dir / ("page-" + std::to_string(page) + ".png")).string(), cv::IMREAD_GRAYSCALE);
    if (picture.empty()) return pages;
    pages.emplace_back(picture);
  }
}

struct Found {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
};

Found Detect(const cv::Mat1b& picture, int dictionary) {
  Found found;
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(picture, cv::aruco::getPredefinedDictionary(dictionary), found.corners, found.ids,
                           parameters);
  return found;
}

/// The corners of the squares between the markers, by number; empty where the board is not as OpenCV expects it.
std::vector<cv::Point2f> BoardCorners(const cv::Mat1b& page, const CharucoBoard& board) {
  const Found found = Detect(page, cv::aruco::DICT_5X5_50);
  EXPECT_EQ(found.ids.size(), static_cast<std::size_t>(board.columns * board.rows / 2));
  const auto expected = cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.square_mm),
                                                        static_cast<float>(board.marker_mm),
                                                        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_50));
  cv::Mat corners, ids;
  cv::aruco::interpolateCornersCharuco(found.corners, found.ids, page, expected, corners, ids);
  std::vector<cv::Point2f> ordered(static_cast<std::size_t>((board.columns - 1) * (board.rows - 1)));
  if (corners.total() != ordered.size()) return {};
  for (int i = 0; i < ids.rows; ++i) ordered[static_cast<std::size_t>(ids.at<int>(i))] = corners.at<cv::Point2f>(i);
  return ordered;
}

/// Longest run of dark pixels in any row, mm: on a page without solid black as wide, the ruler.
double LongestDarkRun(const cv::Mat1b& page, double dpi) {
  int longest = 0;
  for (int y = 0; y < page.rows; ++y) {
    for (int x = 0, run = 0; x < page.cols; ++x) {
      run = page(y, x) < 128 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  return longest * kMmPerInch / dpi;
}

TEST(PrintedBoard, HasItsExactSizeForBothRanges) {
  STRIAE_NEED_POPPLER();
  constexpr double kDpi = 200, kMmPerPixel = kMmPerInch / kDpi;
  for (const RigRange range : {RigRange::kSmall, RigRange::kLarge}) {
    const CharucoBoard board = BoardFor(range);
    const auto pages = Pages(PdfBoard(board, kMadeAt).value(), kDpi);
    ASSERT_EQ(pages.size(), 1U);
    const PaperSize paper = PaperFor(board).value();
    EXPECT_NEAR(pages[0].cols * kMmPerPixel, paper.width_mm, kMmPerPixel);
    EXPECT_NEAR(pages[0].rows * kMmPerPixel, paper.height_mm, kMmPerPixel);
    const auto corners = BoardCorners(pages[0], board);
    ASSERT_FALSE(corners.empty());
    const std::size_t across = static_cast<std::size_t>(board.columns - 1);
    const std::size_t last = corners.size() - 1;
    // A fifth of a pixel: what refinement of a corner in a rendered page leaves. 0.1 % of scale would be 0.2 mm.
    constexpr double kNear = 0.2 * kMmPerPixel;
    EXPECT_NEAR(cv::norm(corners[across - 1] - corners[0]) * kMmPerPixel, (board.columns - 2) * board.square_mm, kNear);
    EXPECT_NEAR(cv::norm(corners[last] - corners[across - 1]) * kMmPerPixel, (board.rows - 2) * board.square_mm, kNear);
    EXPECT_NEAR(cv::norm(corners[1] - corners[0]) * kMmPerPixel, board.square_mm, kNear);
  }
  EXPECT_EQ(PaperFor(BoardFor(RigRange::kSmall))->name, "A4");
  EXPECT_EQ(PaperFor(BoardFor(RigRange::kLarge))->name, "A3");
}

TEST(PrintedBoard, CannotBeTakenForALabel) {
  STRIAE_NEED_POPPLER();
  const auto pages = Pages(PdfBoard(BoardFor(RigRange::kSmall), kMadeAt).value(), 150);
  // Pieces of its markers can look like small ones of 4x4 bits, the markers themselves never do.
  for (const auto& corners : Detect(pages.at(0), cv::aruco::DICT_4X4_1000).corners) {
    EXPECT_LT(cv::norm(corners[0] - corners[1]) * kMmPerInch / 150, kSmallestLabelMm / 2);
  }
}

TEST(PrintedBoard, SaysWhatItIsInText) {
  STRIAE_NEED_POPPLER();
  const testing::TempDir dir;
  const auto pdf = PdfBoard(BoardFor(RigRange::kSmall), kMadeAt).value();
  std::ofstream(dir / "b.pdf", std::ios::binary).write(reinterpret_cast<const char*>(pdf.data()), std::ssize(pdf));
  const std::string text = testing::RunProgram("pdftotext", {(dir / "b.pdf").string(), "-"}).out;
  for (const char* part : {"7 x 5 squares of 36 mm", "markers 27 mm", "DICT_5X5_50", "100 %", "100 mm long", "A4"}) {
    EXPECT_THAT(text, ::testing::HasSubstr(part));
  }
}

TEST(PrintedBoard, IsRefusedWhereItCannotBe) {
  const std::string name(kBoardDictionary);
  for (const CharucoBoard& board : {CharucoBoard{2, 5, 30, 20, name},
                                    {7, 4, 30, 20, name},
                                    {7, 5, 30, 30, name},
                                    {7, 5, 30, 0, name},
                                    {7, 5, 30, -1, name},
                                    {7, 5, 30, std::nan(""), name},
                                    {9, 7, 60, 45, name},
                                    {11, 11, 20, 15, name},
                                    {7, 5, 30, 20, "DICT_6X6_50"}}) {
    const auto pdf = PdfBoard(board, kMadeAt);
    ASSERT_FALSE(pdf) << board.columns << " x " << board.rows;
    EXPECT_EQ(pdf.error().code, ErrorCode::kUsage);
  }
}

LabelCard Card(int id, double side_mm) { return {{id, side_mm, "3F2A-91BC"}, {"S001  V1", "WND-01"}}; }

TEST(PrintedLabels, HaveTheirExactSizeAndNumber) {
  STRIAE_NEED_POPPLER();
  constexpr double kDpi = 300, kMmPerPixel = kMmPerInch / kDpi;
  for (const double side : {20.0, 40.0, 100.0, 140.0}) {
    const auto pages = Pages(PdfLabels({Card(177, side)}, kMadeAt).value(), kDpi);
    ASSERT_EQ(pages.size(), 1U);
    const Found found = Detect(pages[0], cv::aruco::DICT_4X4_1000);
    ASSERT_EQ(found.ids, std::vector<int>{177}) << side;
    for (std::size_t i = 0; i < 4; ++i) {
      // The refined corner lies within a third of a pixel of the printed one: 0.03 mm.
      EXPECT_NEAR(cv::norm(found.corners[0][i] - found.corners[0][(i + 1) % 4]) * kMmPerPixel, side, 0.06) << side;
    }
  }
}

TEST(PrintedLabels, FillPagesInRows) {
  STRIAE_NEED_POPPLER();
  std::vector<LabelCard> cards;
  for (int id = 0; id < 17; ++id) cards.push_back(Card(id * 59, 40));
  const auto pages = Pages(PdfLabels(cards, kMadeAt).value(), 150);
  ASSERT_EQ(pages.size(), 2U);
  std::vector<int> ids;
  for (const cv::Mat1b& page : pages) {
    const Found found = Detect(page, cv::aruco::DICT_4X4_1000);
    ids.insert(ids.end(), found.ids.begin(), found.ids.end());
    EXPECT_NEAR(LongestDarkRun(page, 150), 100, 2 * kMmPerInch / 150) << "the ruler on each page";
  }
  std::sort(ids.begin(), ids.end());
  ASSERT_EQ(ids.size(), cards.size());
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], cards[i].label.marker_id);
}

TEST(PrintedLabels, RefuseWhatCannotBePrinted) {
  for (const auto& cards : {std::vector<LabelCard>{},
                            {Card(1, 19)},
                            {Card(1, 141)},
                            {Card(1, std::nan(""))},
                            {Card(1000, 40)},
                            {Card(-1, 40)}}) {
    const auto pdf = PdfLabels(cards, kMadeAt);
    ASSERT_FALSE(pdf);
    EXPECT_EQ(pdf.error().code, ErrorCode::kUsage);
  }
}

TEST(PrintedLabels, AreTheSameBytesEachTime) {
  EXPECT_EQ(PdfLabels({Card(5, 40)}, kMadeAt).value(), PdfLabels({Card(5, 40)}, kMadeAt).value());
}

/// A page as the camera sees it under the stripes: `mm_per_pixel` on the object, stripes along rows, half of each dark
/// (2 % of the light) and a little room light; then one period averaged across the stripes, as a reader does.
cv::Mat1b SeenUnderStripes(const cv::Mat1b& page, double page_dpi, double mm_per_pixel, double period_mm) {
  cv::Mat small;
  const double scale = kMmPerInch / page_dpi / mm_per_pixel;
  cv::resize(page, small, {}, scale, scale, cv::INTER_AREA);
  cv::Mat1f seen(small);
  const double period = period_mm / mm_per_pixel;
  for (int y = 0; y < seen.rows; ++y) {
    const double n = std::fmod(y / period, 1.0);
    seen.row(y) *= n < 0.5 ? 1.0 : 0.05;
  }
  cv::Mat1f even;
  cv::blur(seen, even, {1, static_cast<int>(std::lround(period))});
  cv::Mat1b grey;
  even.convertTo(grey, CV_8U, 1.6);
  return grey;
}

TEST(PrintedLabels, AreReadUnderTheStripesOfTheirRange) {
  STRIAE_NEED_POPPLER();
  const struct {
    RigRange range;
    double mm_per_pixel, period_mm;  // OPTICS: 5.5 um pixels at 50 mm focal length; 300 mm / 140 and 700 mm / 67
  } rigs[] = {{RigRange::kSmall, 0.105, 300.0 / 140}, {RigRange::kLarge, 0.215, 700.0 / 67}};
  for (const auto& rig : rigs) {
    const double side = DefaultLabelSideMm(rig.range);
    const auto pages = Pages(PdfLabels({Card(177, side)}, kMadeAt).value(), 300);
    const Found found =
        Detect(SeenUnderStripes(pages.at(0), 300, rig.mm_per_pixel, rig.period_mm), cv::aruco::DICT_4X4_1000);
    ASSERT_EQ(found.ids, std::vector<int>{177}) << side;
    // Averaging over a period moves the upper and lower edge by less than half of it.
    EXPECT_NEAR(cv::norm(found.corners[0][0] - found.corners[0][1]) * rig.mm_per_pixel, side, rig.period_mm / 2);
  }
}

}  // namespace
}  // namespace striae::report
