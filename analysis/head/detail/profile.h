// Landmarks of a face in a single capture: what takes the place of a neutral pose.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "analysis/head/detail/cloud.h"

namespace striae::head::detail {

/// The point of the cloud nearest to a pixel, or none within 40 px (8 mm at 2 m).
std::optional<Eigen::Vector3d> PointAt(const Cloud& cloud, const Eigen::Vector2d& pixel);

/// Brow and chin on the midline; mm, relative to one and the same point.
struct Profile {
  Eigen::Vector3d brow, chin;
};

/// The line that rests on brow and chin (glabella and pogonion) within the symmetry plane, relative to `on_plane`.
/// Heights are along the line itself, found by repetition from `up` on, so that it turns with the head. `right` is the
/// plane's unit normal. None where nose, brow or chin are not measured, the nose does not stand out before the line, or
/// that would lie more than 50 degrees off `up`.
std::optional<Profile> FacialLine(const Cloud& cloud, const Eigen::Vector3d& on_plane, const Eigen::Vector3d& right,
                                  const Eigen::Vector3d& up);

}  // namespace striae::head::detail
