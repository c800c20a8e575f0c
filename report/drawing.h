// A vector picture as a list of shapes, so that one plot gives the same picture in HTML (SVG) and in PDF (Cairo).
#pragma once

#include <string>
#include <vector>

#include "core/image.h"

namespace striae::report {

/// Points, x right, y down.
struct Point {
  double x = 0, y = 0;
};

enum class Anchor { kStart, kMiddle, kEnd };

struct Shape {
  enum class Kind { kLine, kPolygon, kCircle, kText };
  Kind kind = Kind::kLine;
  std::vector<Point> points;  ///< line: two or more, polygon: three or more, circle: centre, text: baseline
  double size = 1;            ///< stroke width; circle: radius; text: font size
  Rgb8 colour;                ///< of the stroke; text: of the letters
  bool filled = false;        ///< polygon, circle: inside in `fill`; lines are never filled
  Rgb8 fill{255, 255, 255};
  double stroke = 1;  ///< width of the outline of polygons and circles; 0 = none
  bool dashed = false;
  std::string text;
  Anchor anchor = Anchor::kStart;
  bool bold = false;
};

struct Drawing {
  double width = 0, height = 0;  ///< points (1/72 inch) in print
  std::vector<Shape> shapes;     ///< first drawn first
  std::string description;       ///< what a person who cannot see it must know

  void Line(std::vector<Point> points, double width_pt, Rgb8 colour, bool dashed = false);
  void Polygon(std::vector<Point> points, Rgb8 fill, Rgb8 outline, double outline_pt);
  void Circle(Point centre, double radius, Rgb8 fill, Rgb8 outline, double outline_pt);
  void Text(Point baseline, double size, std::string text, Rgb8 colour, Anchor anchor = Anchor::kStart,
            bool bold = false);
};

/// As an <svg> element with viewBox (no fixed size), role="img" and a <title>.
std::string ToSvg(const Drawing& drawing);
/// The same as a file of its own, with the namespace that viewers ask for; a page must not name any address.
std::string SvgFile(const Drawing& drawing);

/// As pixels on white, `scale` pixels a point.
ImageRgb Rasterise(const Drawing& drawing, double scale);

}  // namespace striae::report
