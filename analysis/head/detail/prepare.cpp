#include "analysis/head/detail/prepare.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace striae::head::detail {
namespace {

Cloud MirroredAt(Cloud cloud, float middle) {
  for (auto& p : cloud.point) p.x() = 2 * middle - p.x();
  for (auto& n : cloud.normal) n.x() = -n.x();
  return cloud;
}

}  // namespace

Status Check(const Options& options) {
  const Eigen::Vector3d up = options.up_in_camera;
  if (!up.allFinite() || up.norm() < 0.5 || std::abs(up.normalized().z()) > 0.86) {
    return Fail(ErrorCode::kUsage, "the subject's up must be a unit vector across the optical axis");
  }
  if (!(options.spacing_mm >= 0.5 && options.spacing_mm <= 6) || options.resamples < 20 || options.resamples > 100000) {
    return Fail(ErrorCode::kUsage, "spacing must be 0.5 to 6 mm, and resamples 20 to 100000");
  }
  return {};
}

Result<std::pair<Cloud, Cloud>> Prepare(const Surface& surface, double spacing_mm, const char* which) {
  const std::string where = std::string("preparing the ") + which + " capture";
  auto fine = WithNormals(Thin(surface, spacing_mm), std::max(5.0, 3 * spacing_mm));
  if (!fine) return Fail(fine.error(), where);
  auto coarse = WithNormals(Thin(surface, 3 * spacing_mm), 8 * spacing_mm);
  if (!coarse) return Fail(coarse.error(), where);
  return std::pair{std::move(*fine), std::move(*coarse)};
}

Eigen::Vector3d Middle(const Cloud& cloud) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : cloud.point) middle += p.cast<double>();
  return middle / static_cast<double>(std::max<std::size_t>(1, cloud.size()));
}

Patch MakePatch(const Cloud& fine, const std::vector<std::uint32_t>& indices) {
  Patch patch;
  patch.fine = Select(fine, indices);
  std::vector<std::uint32_t> few;
  for (std::size_t i = 0; i < indices.size(); i += 9) few.push_back(indices[i]);
  patch.coarse = Select(fine, few);
  return patch;
}

Patch Mirrored(const Patch& patch) {
  const auto middle = static_cast<float>(Middle(patch.coarse).x());
  return {MirroredAt(patch.coarse, middle), MirroredAt(patch.fine, middle)};
}

}  // namespace striae::head::detail
