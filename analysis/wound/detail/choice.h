// Which ring of healthy skin is taken, and whether the skin that it gives may be trusted.
#pragma once

#include <string>
#include <vector>

#include "analysis/wound/detail/null_wound.h"
#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/report.h"
#include "analysis/wound/detail/ring.h"
#include "analysis/wound/detail/swelling.h"

namespace striae::wound {

/// One ring and the skin that it gives.
struct Attempt {
  Ring ring;
  RingWeights weights;
  Skin skin;
  RadialTrend trend;
  double quadric_rms_mm = 0;  ///< of the ring about the quadric that the trend is seen against
};

/// The chosen ring, and what the neighbouring gaps would have given.
struct Choice {
  Attempt chosen;
  Swelling swelling;
  bool settled = false;
  double first_gap_mm = 0, first_volume_mm3 = 0;
  std::vector<double> other_gap_volumes_mm3;
};

/// The ring begins beside the line, or where swelling ends. Where no outer skin tells of swelling, the gaps are tried
/// outwards until the ring shows no radial trend. Rings far out are taken from `coarse`. kMeasurementRefused when even
/// the first ring is cut off.
Result<Choice> ChooseRing(const Scene& scene, const Scene& coarse, const Bed& bed, const Options& options);

/// Which model of the skin continues healthy skin best, and how that was found.
struct ModelChoice {
  std::size_t model = 0;                                           ///< of kSkinModels
  std::string by;                                                  ///< "null wounds", "sectors of the ring"
  std::array<std::optional<double>, kSkinModels.size()> score_mm;  ///< rms error of each; none where it does not fit
};

/// Compares the models on intact skin (three null wounds or more), else by leaving out sectors of the ring in turn.
/// The usual model stays unless another is better by a third and by more than a hundredth of a millimetre.
ModelChoice ChooseModel(const Attempt& attempt, const IntactSkin& intact);

/// Refuses skin that cannot be continued (too steep, not smooth), and flags what is doubtful.
Status CheckRing(const Choice& choice, const Options& options, Flags& flags);

/// printf of one number into a message.
std::string Format(const char* format, double value);

}  // namespace striae::wound
