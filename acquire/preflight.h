// Was the photograph taken as the method asks? One honest verdict an item, for the person at the rig.
#pragma once

#include <vector>

#include "core/study.h"

namespace striae::acquire {

/// Compares a photograph's metadata with the rig's settings (OPTICS: Nikon D90, 50 mm, f/11, 1/200 s, ISO 200-500,
/// flash, full-size picture, focus at 1 m (small) or 2 m (large), manual focus).
/// kFailed: the stripes or the calibration cannot be trusted. kWarning: quality suffers. kUnknown: the file does not
/// say. The order of the items is fixed.
std::vector<PreflightItem> Preflight(const PhotoMetadata& photo, RigRange range);

/// The worst state of all items, where kUnknown is worse than kOk and better than kWarning.
PreflightItem::State Verdict(const std::vector<PreflightItem>& items);

}  // namespace striae::acquire
