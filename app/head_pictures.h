// Pictures of one measurement of a head: what was laid on what, how well it fits, and the angles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/head/measure.h"
#include "core/measurement.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

/// Writes into `folder`, which is made: before.png (both captures as they were photographed), after.png (the neutral
/// head and torso each moved onto the other capture), residuals.png (the distance to the plane in colour, 0 to 1 mm,
/// whatever the fit: pictures can be laid side by side) and angles.png (the pose's torso laid on the neutral one, the
/// head's axes and the three angles); each from the front, the subject's right side and the top. The neutral capture is
/// blue, the other one orange. The same input gives the same bytes. Returns their paths.
Result<std::vector<std::string>> WriteHeadPictures(const std::filesystem::path& folder, const Surface& neutral,
                                                   const Surface& pose, const head::HeadFits& fits,
                                                   const AnalysisReport& report);

}  // namespace striae::app
