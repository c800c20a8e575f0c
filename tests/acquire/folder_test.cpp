#include "acquire/folder.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace striae::acquire {
namespace {

namespace fs = std::filesystem;

void Touch(const fs::path& path, const std::string& content = "x") {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << content;
}

std::vector<std::string> NamesIn(const fs::path& root, const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.lexically_relative(root).generic_string());
  return names;
}

TEST(Folder, ACardYieldsItsPhotographsInOrder) {
  const testing::TempDir card;
  for (const char* name : {"DCIM/101NCD90/DSC_0001.JPG", "DCIM/100NCD90/DSC_0002.NEF", "DCIM/100NCD90/DSC_0002.JPG",
                           "DCIM/100NCD90/DSC_0001.jpeg"}) {
    Touch(card / name);
  }
  for (const char* other : {"DCIM/100NCD90/._DSC_0001.JPG", "DCIM/100NCD90/DSC_0003.JPG.part", "DCIM/100NCD90/INFO.TXT",
                            "NIKON001.DSC", ".Trashes/DSC_0009.JPG", "DCIM/100NCD90/DSC_0004.MOV"}) {
    Touch(card / other);
  }
  const auto files = ListPhotographs({card.path()});
  ASSERT_TRUE(files) << files.error().Describe();
  EXPECT_THAT(NamesIn(card.path(), *files),
              ::testing::ElementsAre("DCIM/100NCD90/DSC_0001.jpeg", "DCIM/100NCD90/DSC_0002.JPG",
                                     "DCIM/100NCD90/DSC_0002.NEF", "DCIM/101NCD90/DSC_0001.JPG"));
}

TEST(Folder, AFileNamedTwiceComesOnce) {
  const testing::TempDir folder;
  Touch(folder / "a.jpg");
  const auto files = ListPhotographs({folder.path(), folder / "a.jpg"});
  ASSERT_TRUE(files);
  EXPECT_EQ(files->size(), 1U);
}

TEST(Folder, AnExplicitFileIsTakenWhateverItsName) {
  const testing::TempDir folder;
  Touch(folder / "scan.bin");
  const auto files = ListPhotographs({folder / "scan.bin"});
  ASSERT_TRUE(files);
  EXPECT_EQ(files->size(), 1U);  // its structure decides, not its name
}

TEST(Folder, WhatIsMissingIsNamed) {
  const testing::TempDir folder;
  const auto absent = ListPhotographs({folder / "nothing.jpg"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(absent.error().message, ::testing::HasSubstr("nothing.jpg"));
  const auto empty = ListPhotographs({folder.path()});
  ASSERT_FALSE(empty);
  EXPECT_THAT(empty.error().message, ::testing::HasSubstr("no JPEG or NEF"));
}

TEST(Folder, BytesArriveAsTheyAreAndBound) {
  const testing::TempDir folder;
  Touch(folder / "DSC_0001.JPG", std::string("\xFF\xD8\0rest", 7));
  CaptureBinding binding;
  binding.role = {CaptureRole::Kind::kWound, "W1"};
  FolderSource source({folder / "DSC_0001.JPG"}, binding);
  const auto item = source.Next();
  ASSERT_TRUE(item && *item);
  EXPECT_EQ((*item)->bytes, (std::vector<std::uint8_t>{0xFF, 0xD8, 0, 'r', 'e', 's', 't'}));
  EXPECT_EQ((*item)->file_name, "DSC_0001.JPG");
  ASSERT_TRUE((*item)->binding);
  EXPECT_EQ((*item)->binding->role.label, "W1");
  const auto end = source.Next();
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->has_value());
}

TEST(Folder, AfterAnUnreadableFileTheNextOneComes) {
  const testing::TempDir folder;
  Touch(folder / "b.jpg");
  FolderSource source({folder / "gone.jpg", folder / "b.jpg"}, {});
  const auto gone = source.Next();
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, ErrorCode::kIo);
  const auto next = source.Next();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ((*next)->file_name, "b.jpg");
}

}  // namespace
}  // namespace striae::acquire
