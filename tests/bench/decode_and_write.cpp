// The least that a photograph's way to a surface file costs: decoding the JPEG and writing a PLY of the same surface,
// with the program's own decoder and encoder, and nothing between.
// decode_and_write PHOTOGRAPH SURFACE.ply OUT.ply RUNS: prints the median seconds of both together.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "app/io/photograph.h"
#include "core/ply.h"

namespace {

std::vector<std::uint8_t> ReadAll(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto surface = striae::DecodePly(ReadAll(argv[2]));
  if (!surface) return 1;
  std::vector<double> seconds;
  for (int run = 0; run < std::atoi(argv[4]); ++run) {
    std::remove(argv[3]);  // what is there already takes longer to take away than to write
    const auto start = std::chrono::steady_clock::now();
    const auto photograph = striae::app::DecodePhotograph(ReadAll(argv[1]));
    if (!photograph) return 1;
    std::ofstream out(argv[3], std::ios::binary | std::ios::trunc);
    const bool written = striae::EncodePly(*surface, [&](std::span<const std::uint8_t> piece) {
      out.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
      return out.good();
    });
    out.close();
    if (!written || !out) return 1;
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + static_cast<long>(seconds.size() / 2), seconds.end());
  std::printf("%.4f\n", seconds[seconds.size() / 2]);
  return 0;
}
