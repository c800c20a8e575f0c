// What a drawn line says about itself: how shaky it is, and the line that was meant.
#pragma once

#include "analysis/wound/detail/polygon.h"

namespace striae::wound {

/// Of a polygon whose points are each off by chance.
struct LineStudy {
  double roughness = 0;  ///< standard deviation of a point across the line, from its neighbours on either side
  double area_sd = 0;    ///< what that makes of the enclosed area: each point's share of it is half the chord beside it
};

/// Each point is compared with the cubic through two neighbours on either side; the sd is robust, and corners where the
/// line turns by more than 60 degrees say nothing. Points on a smooth line give zero. Needs eight points, else zero.
LineStudy StudyLine(const Polygon& drawn);

/// The closed curve that the drawn points were set on: centripetal Catmull-Rom (Yuksel et al., Comput Aided Des 2011,
/// 43:747) through every point, because the polygon of few points loses area to its chords: 1 - sin(2 pi / n) / (2 pi /
/// n) of a circle, 2.3 % with 17. A point where the line turns by more than 75 degrees is a corner that was meant; a
/// polygon of fewer than eight points, and one whose curve would cross itself, stays as it is.
Polygon ClosedCurve(const Polygon& drawn);

/// The line without its shakes: Gaussian means along it, once more on what they took away (so that round outlines do
/// not shrink). Evenly spaced points; `sd` in their unit of length, 0 leaves the line as it is.
Polygon Smoothed(const Polygon& even, double sd);

}  // namespace striae::wound
