#include "reconstruct/calibrate/steps.h"

#include <gmock/gmock.h>

namespace striae::reconstruct {
namespace {

TEST(Steps, ReadsImagesAndPositions) {
  for (const char* csv : {"image,position_mm\na.jpg,0\nfolder/b, c.jpg,25.5\n",
                          "\xef\xbb\xbfimage,position_mm\r\na.jpg,0\r\n\"folder/b, c.jpg\",25.5\r\n"}) {
    const auto steps = ParseSteps(csv);
    ASSERT_TRUE(steps) << steps.error().message;
    ASSERT_EQ(steps->size(), 2U);
    EXPECT_EQ((*steps)[1].image, "folder/b, c.jpg");
    EXPECT_EQ((*steps)[1].position_mm, 25.5);
  }
}

TEST(Steps, NamesTheLineThatIsWrong) {
  const struct {
    const char *csv, *line;
  } cases[] = {{"", "line 0"},
               {"a.jpg,0\n", "line 1"},
               {"image,position_mm\n", "line 1"},
               {"image,position_mm\na.jpg\n", "line 2"},
               {"image,position_mm\na.jpg,near\n", "line 2"},
               {"image,position_mm\na.jpg,nan\n", "line 2"},
               {"image,position_mm\na.jpg,0\na.jpg,5\n", "line 3"},
               {"image,position_mm\na.jpg,5\nb.jpg,5\n", "line 3"}};
  for (const auto& [csv, line] : cases) {
    const auto steps = ParseSteps(csv);
    ASSERT_FALSE(steps) << csv;
    EXPECT_THAT(steps.error().message, ::testing::HasSubstr(line)) << csv;
  }
}

}  // namespace
}  // namespace striae::reconstruct
