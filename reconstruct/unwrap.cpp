#include "reconstruct/unwrap.h"

#include <stdexcept>
#include <utility>

#include "reconstruct/detail/unwrap_forms.h"

namespace striae::reconstruct {

Unwrapped Unwrap(ImageF wrapped, const Mask& mask, const Image<std::uint8_t>* misfit) {
  constexpr std::size_t kPixelsAnEdge = 10;  // beyond it, looking for cuts takes longer than sorting all edges
  if (wrapped.width() != mask.width() || wrapped.height() != mask.height()) {
    throw std::logic_error("Unwrap: phase and mask differ in size");
  }
  if (wrapped.size() > std::size_t{1} << 30) throw std::logic_error("Unwrap: image too large");
  const detail::Edges edges(wrapped, mask, misfit);
  const auto cuts = detail::FindCuts(edges, wrapped.size() / kPixelsAnEdge);
  return cuts ? detail::UnwrapBetweenCuts(std::move(wrapped), mask, *cuts) : detail::UnwrapByKruskal(edges);
}

}  // namespace striae::reconstruct
