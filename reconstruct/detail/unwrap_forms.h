// The two forms of the unwrapping. Both give the same result, pixel for pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "reconstruct/detail/unwrap_edges.h"
#include "reconstruct/unwrap.h"

namespace striae::reconstruct::detail {

/// Kruskal's algorithm as the paper has it: all edges sorted, the most reliable joined first. Its time does not depend
/// on the noise.
Unwrapped UnwrapByKruskal(const Edges& edges);

/// The edges across which the unwrapped phase jumps. Kruskal's tree is the minimum spanning tree of the pixels, so the
/// edges that are left out are the maximum spanning tree of the grid's faces, its planar dual; the jump across such an
/// edge is the flow of the residues (faces around which the wrapped phase does not close) along that tree. The
/// tree is grown (Prim) from charged faces only until the charges cancel or reach the outside. Faces that the mask
/// joins are one. nullopt when more than `budget` edges would be looked at: with noise everywhere Kruskal is faster.
std::optional<std::vector<std::uint32_t>> FindCuts(const Edges& edges, std::size_t budget);

/// In the place of the wrapped phase. Unwraps along rows and joins the rows where no edge is cut. `cuts`: edges as
/// unwrap_edges.h numbers them.
Unwrapped UnwrapBetweenCuts(ImageF wrapped, const Mask& mask, const std::vector<std::uint32_t>& cuts);

}  // namespace striae::reconstruct::detail
