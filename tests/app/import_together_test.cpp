// The same card given to two programs at once, as happens when two people sit at one study.
#include <thread>

#include "tests/app/import_study.h"

namespace striae {
namespace {

using nlohmann::json;
using testing::Ran;

class Together : public testing::ProgramStudy {};

TEST_F(Together, TwoImportsOfOneCardTakeEachPhotographOnce) {
  constexpr int kPhotographs = 12;
  for (int i = 0; i < kPhotographs; ++i) {
    const std::string name = "DSC_" + std::to_string(1000 + i) + ".JPG";
    testing::WriteBytes(dir_ / "card/DCIM/100NCD90" / name, Photo(name));
  }
  Ran first, second;
  std::thread one([&] { first = Run({"import", "--session", session_, Path("card")}); });
  std::thread two([&] { second = Run({"import", "--session", session_, Path("card")}); });
  one.join();
  two.join();
  ASSERT_EQ(first.exit_code, 0) << first.err;
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const json a = first.Json(), b = second.Json();
  EXPECT_EQ(a.at("added").get<int>() + b.at("added").get<int>(), kPhotographs);
  EXPECT_EQ(a.at("already_there").get<int>() + b.at("already_there").get<int>(), kPhotographs);
  EXPECT_EQ(Do({"show", session_}).at("captures").size(), kPhotographs);
  const json check = Do({"check"});
  EXPECT_TRUE(check.at("passed"));
  EXPECT_EQ(check.at("findings"), json::array()) << "no file that only one of them wrote is left over";
}

TEST_F(Together, OneCardUnderTwoSubjectsEntersUnderOneOfThemOnly) {
  Do({"subject", "add", "S002"});
  Do({"consent", "S002", "--given", "2026-05-01"});
  const std::string other = Do({"session", "open", "--subject", "S002", "--visit", "V1"}).at("id");
  const std::string photo = WritePhoto("DSC_0001.JPG");
  Ran first, second;
  std::thread one([&] { first = Run({"import", "--session", session_, photo}); });
  std::thread two([&] { second = Run({"import", "--session", other, photo}); });
  one.join();
  two.join();
  EXPECT_EQ(first.exit_code + second.exit_code, 1) << first.err << second.err;
  EXPECT_THAT(first.err + second.err, ::testing::HasSubstr("is in the study already: subject S00"));
  EXPECT_EQ(Do({"status"}).at("captures"), 1);
  EXPECT_EQ(Do({"check"}).at("findings"), json::array());
}

}  // namespace
}  // namespace striae
