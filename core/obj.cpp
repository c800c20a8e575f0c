#include "core/obj.h"

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace striae {
namespace {

void Append(std::string& text, double value, int decimals) {
  std::array<char, 64> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals).ptr;
  text.append(digits.data(), end);
}

void Append(std::string& text, std::uint32_t value) {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

/// The next word of a line, taken off it.
std::string_view Word(std::string_view& line) {
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) {
    line = {};
    return {};
  }
  const auto last = std::min(line.find_first_of(" \t\r", first), line.size());
  const std::string_view word = line.substr(first, last - first);
  line.remove_prefix(last);
  return word;
}

bool ReadVertex(std::string_view line, Surface& surface) {
  Eigen::Vector3f point;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = Word(line);
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), point[axis]);
    if (code != std::errc{} || end != word.data() + word.size()) return false;
  }
  surface.point_in_camera.push_back(point);
  return point.allFinite();
}

bool ReadFace(std::string_view line, Surface& surface) {
  std::vector<std::uint32_t> corners;
  for (std::string_view word = Word(line); !word.empty(); word = Word(line)) {
    long long index = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (code != std::errc{} || (end != word.data() + word.size() && *end != '/')) return false;
    if (index < 0) index += static_cast<long long>(surface.size()) + 1;
    if (index < 1 || index > static_cast<long long>(surface.size())) return false;
    corners.push_back(static_cast<std::uint32_t>(index - 1));
  }
  for (std::size_t k = 2; k < corners.size(); ++k) surface.faces.push_back({corners[0], corners[k - 1], corners[k]});
  return corners.size() >= 3;
}

Rgb8 MeanColour(const Surface& surface) {
  double r = 0, g = 0, b = 0;
  for (const Rgb8& c : surface.colour) {
    r += c.r;
    g += c.g;
    b += c.b;
  }
  const auto mean = [&](double sum) {
    return static_cast<std::uint8_t>(std::lround(sum / static_cast<double>(std::max<std::size_t>(1, surface.size()))));
  };
  return {mean(r), mean(g), mean(b)};
}

/// Gives every empty pixel beside a filled one that one's colour, once.
void SpreadOnce(ImageRgb& image, Mask& filled) {
  const Mask before = filled;
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      if (before(col, row) != 0) continue;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        if (!before.Contains(col + dx, row + dy) || before(col + dx, row + dy) == 0) continue;
        image(col, row) = image(col + dx, row + dy);
        filled(col, row) = 1;
        break;
      }
    }
  }
}

}  // namespace

std::string EncodeObj(const Surface& surface, std::string_view mtl_name) {
  const bool textured = !mtl_name.empty() && surface.HasGrid();
  std::string text = "# striae surface, mm, camera frame: x right, y down, z forward\n";
  for (const std::string& comment : surface.comments) text += "# " + comment + "\n";
  text.reserve(text.size() + surface.size() * (textured ? 52 : 32) + surface.faces.size() * (textured ? 44 : 24));
  if (textured) text += "mtllib " + std::string(mtl_name) + "\n";
  for (const Eigen::Vector3f& point : surface.point_in_camera) {
    text += 'v';
    for (const float value : point) Append(text += ' ', value, 4);  // a tenth of a micrometre
    text += '\n';
  }
  for (std::size_t i = 0; textured && i < surface.size(); ++i) {
    Append(text += "vt ", (surface.col[i] + 0.5) / surface.sensor_width_px, 6);
    Append(text += ' ', 1 - (surface.row[i] + 0.5) / surface.sensor_height_px, 6);
    text += '\n';
  }
  if (textured) text += "usemtl photograph\n";
  for (const auto& face : surface.faces) {
    text += 'f';
    for (const std::uint32_t corner : face) {
      Append(text += ' ', corner + 1);
      if (textured) Append(text += '/', corner + 1);
    }
    text += '\n';
  }
  return text;
}

std::string EncodeMtl(std::string_view texture_name) {
  return "newmtl photograph\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd " + std::string(texture_name) + "\n";
}

ImageRgb TextureOf(const Surface& surface, int margin_px) {
  ImageRgb image(surface.sensor_width_px, surface.sensor_height_px, MeanColour(surface));
  Mask filled(image.width(), image.height(), 0);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!image.Contains(surface.col[i], surface.row[i])) continue;
    image(surface.col[i], surface.row[i]) = surface.colour[i];
    filled(surface.col[i], surface.row[i]) = 1;
  }
  for (int i = 0; i < margin_px; ++i) SpreadOnce(image, filled);
  return image;
}

Result<Surface> DecodeObj(std::string_view text) {
  Surface surface;
  for (std::size_t at = 0, number = 1; at < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    const std::string_view keyword = Word(line);
    const bool good = keyword == "v" ? ReadVertex(line, surface) : keyword == "f" ? ReadFace(line, surface) : true;
    if (!good) return Fail(ErrorCode::kBadFile, "line " + std::to_string(number) + " of the OBJ cannot be read");
  }
  if (surface.size() == 0) return Fail(ErrorCode::kBadFile, "the OBJ holds no vertex");
  surface.colour.assign(surface.size(), Rgb8{200, 200, 200});
  surface.quality.assign(surface.size(), 1.0F);
  return surface;
}

}  // namespace striae
