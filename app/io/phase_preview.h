// Pictures of what was measured in a photograph before it became a surface, for people.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "reconstruct/phase.h"

namespace striae::app {

/// PNG of the unwrapped phase in stripes, from the photograph's first to its last, viridis with a bar; white where
/// there is none.
Result<std::vector<std::uint8_t>> PhasePreview(const reconstruct::PhaseResult& phase, int max_side_px = 1200);

/// PNG of the modulation on the fixed scale 0 to 1, measured or not.
Result<std::vector<std::uint8_t>> ModulationPreview(const reconstruct::PhaseResult& phase, int max_side_px = 1200);

/// PNG of the photograph with its parts tinted: measured (green), not measured (dark), saturated (red); with a legend.
Result<std::vector<std::uint8_t>> MaskPreview(const Photograph& photograph, const Mask& mask, int max_side_px = 1200);

}  // namespace striae::app
