// What a body's surface reflects at a place: vertex colours, and what is painted over them.
#pragma once

#include <optional>

#include "acquire/rig/detail/ray_scene.h"
#include "acquire/rig/mesh.h"

namespace striae::rig::detail {

/// Linear RGB of the body's own surface.
Eigen::Vector3f SkinAlbedo(const TriangleMesh& mesh, const Hit& where);

/// The grey that decals give the point (mesh frame); nothing where none lies.
std::optional<float> PaintAt(const TriangleMesh& mesh, const Eigen::Vector3d& point);

/// A decal lies within `margin_mm` of the point: its pixel is worth more samples.
bool NearPaint(const TriangleMesh& mesh, const Eigen::Vector3d& point, double margin_mm);

}  // namespace striae::rig::detail
