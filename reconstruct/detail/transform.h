// FFTW's one-dimensional transforms in single precision.
#pragma once

#include <memory>

#include <fftw3.h>

namespace striae::reconstruct::detail {

struct FreeFftw {
  void operator()(void* memory) const { fftwf_free(memory); }
};
template <typename T>
using FftwArray = std::unique_ptr<T[], FreeFftw>;

FftwArray<float> RealArray(int size);
FftwArray<fftwf_complex> ComplexArray(int size);

/// The next length that FFTW does fast: a power of two times 1, 3, 5, 9, 15 or 45. The sensor's own 4288 and 2848 have
/// large prime factors and take several times longer.
int FastLength(int least);

/// Real to half spectrum, and spectrum to complex signal, of one length. Safe to use from several threads.
class Plans {
 public:
  explicit Plans(int length);
  ~Plans();
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;
  /// Arrays from RealArray and ComplexArray only: FFTW counts on their alignment.
  void Forward(float* in, fftwf_complex* out) const { fftwf_execute_dft_r2c(forward_, in, out); }
  void Inverse(fftwf_complex* in, fftwf_complex* out) const { fftwf_execute_dft(inverse_, in, out); }

 private:
  fftwf_plan forward_ = nullptr, inverse_ = nullptr;
};

}  // namespace striae::reconstruct::detail
