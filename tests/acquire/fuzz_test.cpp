// Bytes of any kind: no crash, no read outside, a value or an error. Run under the sanitizers this is the fuzzer's
// replay; the corpus is made here from whole photographs.
#include <random>

#include <gtest/gtest.h>

#include "tests/acquire/fuzz_photo.h"
#include "tests/support/ptp_photo.h"

namespace striae::acquire {
namespace {

using Bytes = std::vector<std::uint8_t>;

void ReadAnything(const Bytes& bytes) { EXPECT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0); }

std::vector<Bytes> Corpus() {
  testing::PhotoOptions small;
  small.width = 40;
  small.height = 24;
  testing::PhotoOptions bare = small;
  bare.with_exif = false;
  return {testing::MakeJpeg(small), testing::MakeJpeg(bare), testing::MakeNef(small, 64)};
}

TEST(FuzzReplay, EveryByteOfAPhotographMayBeWrong) {
  for (const auto& seed : Corpus()) {
    for (std::size_t at = 0; at < seed.size(); ++at) {
      for (const int value : {0x00, 0x7F, 0xFF, seed[at] ^ 0x01}) {
        Bytes changed = seed;
        changed[at] = static_cast<std::uint8_t>(value);
        ReadAnything(changed);
      }
    }
  }
}

TEST(FuzzReplay, RandomDamageAndCuts) {
  std::mt19937 random(20261122);  // fixed: the same files every time
  for (const auto& seed : Corpus()) {
    for (int round = 0; round < 1500; ++round) {
      Bytes changed = seed;
      const int edits = 1 + static_cast<int>(random() % 8);
      for (int edit = 0; edit < edits; ++edit) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
      if (random() % 3 == 0) changed.resize(random() % changed.size());
      ReadAnything(changed);
    }
  }
}

}  // namespace
}  // namespace striae::acquire
