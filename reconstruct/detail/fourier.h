// The Fourier stage on lines across the stripes: background, Hann window, analytic signal.
#pragma once

#include <vector>

#include "reconstruct/detail/line_block.h"
#include "reconstruct/detail/transform.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct::detail {

/// Takeda's Fourier transform profilometry, line by line. Lines are padded to a length that FFTW likes.
class LineAnalysis {
 public:
  LineAnalysis(int length, double period_px, const BandWindow& window, bool remove_background = true);

  /// One thread's memory.
  class Scratch {
   public:
    explicit Scratch(const LineAnalysis& analysis);

   private:
    friend class LineAnalysis;
    FftwArray<float> lines, amplitudes, stripes;  ///< kLanes rows of length_
    FftwArray<float> real;
    FftwArray<fftwf_complex> spectrum, signal;
    Lanes<float> once, groups;
  };

  /// All of length * kLanes values.
  struct Signal {
    float* phase;       ///< wrapped, rad, in (-pi, pi]; 0 at the centre of a bright stripe
    float* amplitude;   ///< of the fundamental, in the units of the signal
    float* background;  ///< local mean over one period, twice: zero at the carrier and its harmonics
    float* stripes;     ///< amplitude * cos(phase)
  };
  void Background(const float* light, float* background, Scratch& scratch) const;
  /// Phase, amplitude and stripes of light whose background is in `out` already.
  void Stripes(const float* light, const Signal& out, Scratch& scratch) const;

  /// How far the light is from following the stripes found in it, as LaneMisfit keeps it: over one and a
  /// half periods, by means over a quarter of a period, which leave a third of the grating's third harmonic. Where the
  /// surface steps, ends or folds within a period, or light saturates, no phase that is smooth enough for the window
  /// describes the light, and what it leaves over is about as large as what it took up wrongly. A slope that the window
  /// only dims does not count.
  void Misfit(const float* light, const Signal& signal, std::uint8_t* misfit, Scratch& scratch) const;

  /// No amplitude in the block reaches `least_amplitude`, or `least_modulation` of the darkest part of it; told from
  /// its mean over all lines. False when in doubt. Most of a photograph is often unlit, and done with for a third of
  /// the time.
  [[nodiscard]] bool Unlit(const float* light, float least_amplitude, float least_modulation) const;

  /// Standard deviation of the amplitude's two components where light falls, from the band above the harmonics: the
  /// median over the lines that it falls on (over all where it falls on none), all of a line's noise put down to its
  /// lit part.
  [[nodiscard]] double Noise(const std::vector<Lanes<float>>& blocks) const;

 private:
  void Transform(const float* line, Scratch& scratch) const;
  int length_, padded_, first_ = 0;
  double period_px_;
  bool remove_background_;
  std::vector<float> window_;  ///< from bin first_ on: twice the window / padded length
  Plans plans_;
};

}  // namespace striae::reconstruct::detail
