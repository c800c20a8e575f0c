// Where the solver begins: the rig as designed, and the object found roughly before it.
#pragma once

#include <vector>

#include "reconstruct/calibrate/detail/order_residual.h"
#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::detail {

/// Camera and projector as designed, focused on the first photograph's distance; the projector's axis meets the
/// camera's there.
RigParameters NominalRigParameters(const NominalRig& nominal);
/// The same with pose and slide straight ahead.
RigParameters NominalParameters(const NominalRig& nominal, const ReferenceShape& shape);

/// Moves the pose across the field and about the optical axis to where the relief's print on the stripes matches best.
/// The print is the order less its best quadratic in the pixel, so that neither projector nor plate tilt matter.
/// Returns how well they match, the correlation of the two prints.
double FindObject(const ReferenceShape& shape, const CalibrationView& first_view, RigParameters& parameters,
                  std::size_t most_samples = 1200);

/// The angular law's parameters of the same rig: a fan about the same axis that opens as the middle of the grating
/// does.
RigParameters AngularFrom(const RigParameters& pinhole, int axis);

}  // namespace striae::reconstruct::detail
