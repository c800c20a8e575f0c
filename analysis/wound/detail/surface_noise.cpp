#include "analysis/wound/detail/surface_noise.h"

#include <algorithm>
#include <cmath>

namespace striae::wound {
namespace {

constexpr double kMadToSd = 1.4826;
constexpr double kAlike =
    0.6;  // of the stripes' distance: 90 scenes of the virtual rig, two other rigs (docs/wound.md)

template <typename ValueOf>
double MedianOverRing(const Scene& scene, const Ring& ring, ValueOf value_of) {
  std::vector<double> values;
  for (std::size_t c = 0; c < scene.patch.size(); ++c) {
    const double d = scene.place[c].distance;
    const bool in_ring = d >= ring.gap_mm && d <= ring.gap_mm + ring.width_mm;
    if (in_ring && scene.patch.state[c] == Patch::kMeasured) values.push_back(value_of(c));
  }
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double SmoothedRingSd(const Scene& scene, const std::vector<double>& smoothed, const Ring& ring) {
  return kMadToSd * MedianOverRing(scene, ring, [&](std::size_t c) { return std::abs(smoothed[c]); });
}

double SkinUncertainty(const Scene& scene, const Ring& ring) {
  return MedianOverRing(scene, ring, [&](std::size_t c) { return scene.patch.UncertaintyMm(c); });
}

double BeyondSkin(double mm, double skin_mm) { return std::sqrt(std::max(0.0, mm * mm - skin_mm * skin_mm)); }

double VolumeSdOfBed(const Scene& scene, const Bed& bed, double skin_mm, double stripe_mm) {
  const double cell_mm = scene.patch.cell_mm();
  double sum = 0;  // of squares over the cells' areas
  for (const std::size_t cell : bed.cell) {
    const double u = BeyondSkin(scene.patch.UncertaintyMm(cell), skin_mm);
    sum += u * u * cell_mm * cell_mm;
  }
  return kAlike * stripe_mm * std::sqrt(sum);
}

}  // namespace striae::wound
