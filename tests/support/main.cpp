#include <cstdlib>

#include <gmock/gmock.h>

namespace {
/// std::rand based code starts every test from the same place, whatever ran before.
class Reseed : public ::testing::EmptyTestEventListener {
  void OnTestStart(const ::testing::TestInfo&) override { std::srand(1); }
};
}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleMock(&argc, argv);
  ::testing::UnitTest::GetInstance()->listeners().Append(new Reseed);  // gtest owns it
  return RUN_ALL_TESTS();
}
