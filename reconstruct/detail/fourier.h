// The Fourier stage on lines across the stripes: background, carrier, Hann window, analytic signal.
#pragma once

#include <optional>

#include "core/image.h"

namespace striae::reconstruct::detail {

struct Carrier {
  double period_px = 0;
  double prominence = 0;  ///< peak over the higher of the two valleys beside it; natural scenes stay below about 2
};

/// The strongest periodic pattern along the lines: the peak of the mean power spectrum weighted with the frequency
/// (natural scenes fall with it). nullopt when the lines are shorter than eight periods of anything.
std::optional<Carrier> FindCarrier(const ImageF& lines);

/// Every image has the lines' size: width = along the line, across the stripes.
struct AnalyticSignal {
  ImageF phase;       ///< wrapped, rad, in (-pi, pi]; 0 at the centre of a bright stripe
  ImageF amplitude;   ///< of the fundamental, in the units of the signal
  ImageF background;  ///< local mean over one period
  double noise = 0;   ///< standard deviation of the amplitude's components, from the band above the harmonics
};

/// Takeda's Fourier transform profilometry, line by line, with a Hann window over
/// f0 (1 - half_width) .. f0 (1 + half_width) (the paper's section 3). Lines are padded to a length that FFTW likes.
AnalyticSignal AnalyseLines(const ImageF& lines, double period_px, double half_width);

}  // namespace striae::reconstruct::detail
