// Where the solver begins: the rig as designed, and the object found roughly before it.
#pragma once

#include <vector>

#include "reconstruct/calibrate/detail/order_residual.h"
#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::detail {

/// Camera and projector as designed, focused on the first photograph's distance; the projector's axis meets the
/// camera's there; pose and slide straight ahead.
RigParameters NominalParameters(const NominalRig& nominal, const ReferenceShape& shape);

/// Moves the pose across the field and about the optical axis to where the relief's print on the stripes matches best.
/// The print is the order less its best quadratic in the pixel, so that neither projector nor plate tilt matter.
void FindObject(const ReferenceShape& shape, const CalibrationView& first_view, RigParameters& parameters);

}  // namespace striae::reconstruct::detail
