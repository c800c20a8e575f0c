// Two-dimensional phase unwrapping along the reliability path (Herraez et al., Applied Optics 41 (2002) 7437).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::reconstruct {

struct Unwrapped {
  ImageF phase;                ///< rad, wrapped + 2 pi k; NaN outside the mask
  Image<std::int32_t> region;  ///< connected component (4-neighbours) of the mask, 0 the largest; -1 outside
  int regions = 0;
  std::vector<std::size_t> pixels;  ///< of every region
};

/// Unwraps every connected region of the mask by itself; each is one consistent sheet whose first pixel in row order
/// keeps its wrapped value. Pixels are joined in the order of their reliability: an edge between neighbours weighs the
/// sum of both pixels' D, where D is the sum of squared second differences over the eight neighbours (scikit-image's
/// form; the paper's R = 1/D orders the pixels alike). Pixels beside the mask's rim are the least reliable. Equal edges
/// keep their order in the image, so the result does not depend on anything but the input.
/// `wrapped` (given up to the result when moved in) in rad within [-pi, pi]; sizes must agree (std::logic_error).
/// With `misfit` (PhaseResult's) what is no measurement is joined last: a phase may be smooth where it is wrong, and
/// second differences alone then lead the jump between two shadows through the skin beside them.
Unwrapped Unwrap(ImageF wrapped, const Mask& mask, const Image<std::uint8_t>* misfit = nullptr);

}  // namespace striae::reconstruct
