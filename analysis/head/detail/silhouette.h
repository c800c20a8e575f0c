// The outline of a person from the top down: head, what narrows below it, shoulders.
#pragma once

#include <optional>
#include <vector>

#include "analysis/head/detail/cloud.h"

namespace striae::head::detail {

inline constexpr double kBinMm = 6;  ///< two to three points high: a silhouette without holes

/// One unbroken run of the silhouette in a bin: from..to along the subject's right.
struct Run {
  double from = 0, to = 0;
  [[nodiscard]] double Width() const { return to - from; }
  [[nodiscard]] double Middle() const { return (from + to) / 2; }
};

/// Bins of kBinMm from the top down; each has its points' coordinates to the right and forward, sorted by the former.
struct Silhouette {
  struct Point {
    float right, forward;
  };
  double top = 0;
  std::vector<std::vector<Point>> bins;
  [[nodiscard]] double HeightOf(std::size_t bin) const { return top - (static_cast<double>(bin) + 0.5) * kBinMm; }
  [[nodiscard]] std::size_t BinOf(double height) const { return static_cast<std::size_t>((top - height) / kBinMm); }
};

/// Points (subject axes) further back than `back` are left out.
Silhouette Scan(const Points& in_subject, float back);

/// The runs of one body, from its top bin down.
struct Outline {
  std::size_t first = 0;  ///< bin of the top
  std::vector<Run> runs;  ///< width 0 where it is lost in the chin's shadow
};

/// Follows the silhouette from the topmost run of at least 20 mm; each next run is the one that overlaps the last most.
Outline Follow(const Silhouette& silhouette);

/// Indices into the outline's runs.
struct Landmarks {
  std::size_t chin = 0, neck = 0, shoulder = 0;
  double head_width = 0, middle = 0;  ///< mm; the midline of the head's lower half
  double chin_drop_mm = 0;            ///< by which the throat lies behind the chin; 0 where no chin shows
};

/// Neck: narrower than the head and than the shoulders below it. Where hair or a collar hides that, the chin (the
/// midline falls back to the throat below it) divides head and torso. None without shoulders, or with neither.
std::optional<Landmarks> FindLandmarks(const Silhouette& silhouette, const Outline& outline);

}  // namespace striae::head::detail
