#include "reconstruct/detail/transform.h"

#include <cstddef>
#include <mutex>

namespace striae::reconstruct::detail {
namespace {
/// Only planning is not thread-safe in FFTW; plans are made one at a time.
std::mutex& Planning() {
  static std::mutex mutex;
  return mutex;
}
}  // namespace

FftwArray<float> RealArray(int size) { return FftwArray<float>(fftwf_alloc_real(static_cast<std::size_t>(size))); }
FftwArray<fftwf_complex> ComplexArray(int size) {
  return FftwArray<fftwf_complex>(fftwf_alloc_complex(static_cast<std::size_t>(size)));
}

int FastLength(int least) {
  int best = 1;
  while (best < least) best *= 2;
  for (const int odd : {3, 5, 9, 15, 45}) {
    int length = odd;
    while (length < least) length *= 2;
    if (length < best) best = length;
  }
  return best;
}

Plans::Plans(int length) {
  const auto real = RealArray(length);
  const auto a = ComplexArray(length), b = ComplexArray(length);
  const std::lock_guard lock(Planning());
  forward_ = fftwf_plan_dft_r2c_1d(length, real.get(), a.get(), FFTW_ESTIMATE);
  inverse_ = fftwf_plan_dft_1d(length, a.get(), b.get(), FFTW_BACKWARD, FFTW_ESTIMATE);
}

Plans::~Plans() {
  const std::lock_guard lock(Planning());
  fftwf_destroy_plan(forward_);
  fftwf_destroy_plan(inverse_);
}

}  // namespace striae::reconstruct::detail
