// Captures made ready for registration.
#pragma once

#include <utility>
#include <vector>

#include "analysis/head/detail/search.h"
#include "analysis/head/measure.h"
#include "core/result.h"

namespace striae::head::detail {

/// kUsage for options that cannot be meant.
Status Check(const Options& options);

/// Fine and coarse points with normals; normals reach three spacings, as far as skin is flat. `which` capture it is,
/// for errors.
Result<std::pair<Cloud, Cloud>> Prepare(const Surface& surface, double spacing_mm, const char* which);

/// Mean of the points; zero for none.
Eigen::Vector3d Middle(const Cloud& cloud);

/// Every ninth point of the fine patch makes the coarse one, so that both lie on the same skin.
Patch MakePatch(const Cloud& fine, const std::vector<std::uint32_t>& indices);

/// The patch seen in a mirror that stands upright before the camera, through the patch's middle: left and right trade
/// places.
Patch Mirrored(const Patch& patch);

}  // namespace striae::head::detail
