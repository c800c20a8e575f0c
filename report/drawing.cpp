#include "report/drawing.h"

#include <cstdio>
#include <utility>

#include "report/detail/escape.h"

namespace striae::report {
namespace {

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string Hex(Rgb8 colour) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return text;
}

std::string Attribute(std::string_view name, const std::string& value) {
  return " " + std::string(name) + "=\"" + value + "\"";
}

std::string PointList(const std::vector<Point>& points) {
  std::string list;
  for (const Point& p : points) list += (list.empty() ? "" : " ") + Number(p.x) + "," + Number(p.y);
  return list;
}

std::string Outline(const Shape& shape) {
  std::string text = Attribute("fill", shape.filled ? Hex(shape.fill) : "none");
  if (shape.stroke > 0) {
    text += Attribute("stroke", Hex(shape.colour)) + Attribute("stroke-width", Number(shape.stroke));
  }
  return text;
}

std::string TextElement(const Shape& shape) {
  static constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
  std::string text = "<text" + Attribute("x", Number(shape.points[0].x)) + Attribute("y", Number(shape.points[0].y)) +
                     Attribute("font-size", Number(shape.size)) + Attribute("fill", Hex(shape.colour)) +
                     Attribute("text-anchor", std::string(kAnchors[static_cast<int>(shape.anchor)]));
  if (shape.bold) text += Attribute("font-weight", "600");
  return text + ">" + detail::Escape(shape.text) + "</text>";
}

std::string Element(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::kLine:
      return "<polyline" + Attribute("points", PointList(shape.points)) + Attribute("fill", "none") +
             Attribute("stroke", Hex(shape.colour)) + Attribute("stroke-width", Number(shape.size)) +
             (shape.dashed ? Attribute("stroke-dasharray", "3 3") : "") + Attribute("stroke-linejoin", "round") + "/>";
    case Shape::Kind::kPolygon:
      return "<polygon" + Attribute("points", PointList(shape.points)) + Outline(shape) + "/>";
    case Shape::Kind::kCircle:
      return "<circle" + Attribute("cx", Number(shape.points[0].x)) + Attribute("cy", Number(shape.points[0].y)) +
             Attribute("r", Number(shape.size)) + Outline(shape) + "/>";
    case Shape::Kind::kText:
      break;
  }
  return TextElement(shape);
}

}  // namespace

void Drawing::Line(std::vector<Point> points, double width_pt, Rgb8 colour, bool dashed) {
  Shape shape;
  shape.points = std::move(points);
  shape.size = width_pt;
  shape.colour = colour;
  shape.dashed = dashed;
  shapes.push_back(std::move(shape));
}

void Drawing::Polygon(std::vector<Point> points, Rgb8 fill, Rgb8 outline, double outline_pt) {
  Shape shape;
  shape.kind = Shape::Kind::kPolygon;
  shape.points = std::move(points);
  shape.filled = true;
  shape.fill = fill;
  shape.colour = outline;
  shape.stroke = outline_pt;
  shapes.push_back(std::move(shape));
}

void Drawing::Circle(Point centre, double radius, Rgb8 fill, Rgb8 outline, double outline_pt) {
  Shape shape;
  shape.kind = Shape::Kind::kCircle;
  shape.points = {centre};
  shape.size = radius;
  shape.filled = true;
  shape.fill = fill;
  shape.colour = outline;
  shape.stroke = outline_pt;
  shapes.push_back(std::move(shape));
}

void Drawing::Text(Point baseline, double size, std::string text, Rgb8 colour, Anchor anchor, bool bold) {
  Shape shape;
  shape.kind = Shape::Kind::kText;
  shape.points = {baseline};
  shape.size = size;
  shape.text = std::move(text);
  shape.colour = colour;
  shape.anchor = anchor;
  shape.bold = bold;
  shapes.push_back(std::move(shape));
}

namespace {

std::string Svg(const Drawing& drawing, const std::string& name_space) {
  std::string svg = "<svg" + name_space + " viewBox=\"0 0 " + Number(drawing.width) + " " + Number(drawing.height) +
                    "\" role=\"img\" aria-label=\"" + detail::Escape(drawing.description) + "\">\n<title>" +
                    detail::Escape(drawing.description) + "</title>\n";
  for (const Shape& shape : drawing.shapes) svg += Element(shape) + "\n";
  return svg + "</svg>\n";
}

}  // namespace

std::string ToSvg(const Drawing& drawing) { return Svg(drawing, ""); }

std::string SvgFile(const Drawing& drawing) { return Svg(drawing, " xmlns=\"http://www.w3.org/2000/svg\""); }

}  // namespace striae::report
