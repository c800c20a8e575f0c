// The same wrapped phase through scikit-image's unwrap_phase, an independent implementation of Herraez's method.
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/unwrap.h"
#include "tests/support/program.h"
#include "tests/support/temp_dir.h"

namespace striae::reconstruct {
namespace {

constexpr float kTurn = 6.28318530718F;
constexpr const char* kPython = "/usr/bin/python3";  // the system's: script/setup installs scikit-image for it

TEST(UnwrapPeer, AgreesWithScikitImageOnNoisyPhase) {
  if (testing::RunProgram(kPython, {"-c", "import skimage.restoration"}).exit_code != 0) {
    GTEST_SKIP() << "no scikit-image (Debian: python3-skimage)";
  }
  constexpr int kWidth = 200, kHeight = 160;
  ImageF wrapped(kWidth, kHeight);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.9F);  // about 2 % residues
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const float u = (static_cast<float>(col) - 100) / 40, v = (static_cast<float>(row) - 80) / 40;
      const float phase = 18 * std::exp(-u * u - v * v) + 0.15F * static_cast<float>(col) + noise(random);
      wrapped(col, row) = phase - kTurn * std::nearbyint(phase / kTurn);
    }
  }
  const testing::TempDir folder;
  {
    std::ofstream out(folder / "wrapped.raw", std::ios::binary);
    out.write(reinterpret_cast<const char*>(wrapped.pixels().data()),
              static_cast<std::streamsize>(sizeof(float) * wrapped.size()));
  }
  const std::string script =
      "import sys, numpy as np; from skimage.restoration import unwrap_phase; "
      "w = np.fromfile(sys.argv[1], 'f4').reshape(160, 200); "
      "unwrap_phase(w).astype('f4').tofile(sys.argv[2])";
  const auto ran = testing::RunProgram(
      kPython, {"-c", script, (folder / "wrapped.raw").string(), (folder / "unwrapped.raw").string()});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  std::vector<float> peer(wrapped.size());
  std::ifstream(folder / "unwrapped.raw", std::ios::binary)
      .read(reinterpret_cast<char*>(peer.data()), static_cast<std::streamsize>(sizeof(float) * peer.size()));

  const auto ours = Unwrap(wrapped, Mask(kWidth, kHeight, 1));
  const float offset = std::nearbyint((ours.phase(100, 80) - peer[80 * kWidth + 100]) / kTurn);
  int different = 0;
  for (std::size_t i = 0; i < peer.size(); ++i) {
    different += std::abs(ours.phase.pixels()[i] - peer[i] - kTurn * offset) > 1 ? 1 : 0;
  }
  // Not zero: scikit-image draws the reliability of the image's rim from a random generator, and a few isolated noise
  // pixels hang on ties.
  EXPECT_LT(different, 0.005 * kWidth * kHeight);
}

}  // namespace
}  // namespace striae::reconstruct
