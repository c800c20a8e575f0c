#include "core/detail/ply_header.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>
#include <string_view>

namespace striae::detail {
namespace {

constexpr std::size_t kLongestHeader = 1 << 20;
constexpr double kMostCorners = 255;

tl::unexpected<Error> Bad(const std::string& what) { return Fail(ErrorCode::kBadFile, "not a readable PLY: " + what); }

bool ParseType(const std::string& text, PlyType& type) {
  static const std::pair<const char*, PlyType> kTypes[] = {
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},     {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16}, {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},   {"float32", PlyType::kFloat}, {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble}};
  for (const auto& [name, value] : kTypes) {
    if (text == name) {
      type = value;
      return true;
    }
  }
  return false;
}

bool ParseProperty(std::istringstream& words, PlyElement& element) {
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list") {
    std::string count_type;
    words >> count_type >> type;
    property.is_list = true;
    if (!ParseType(count_type, property.count_type)) return false;
  }
  if (!ParseType(type, property.type) || !(words >> property.name)) return false;
  element.properties.push_back(property);
  return true;
}

/// One line after "ply"; an empty string when it was understood.
std::string ParseLine(const std::string& line, PlyHeader& header) {
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  if (keyword == "comment" || keyword == "obj_info") {
    header.comments.push_back(line.size() > keyword.size() ? line.substr(keyword.size() + 1) : "");
  } else if (keyword == "format") {
    std::string format;
    words >> format;
    header.ascii = format == "ascii";
    if (!header.ascii && format != "binary_little_endian") return "format '" + format + "' is not supported";
  } else if (keyword == "element") {
    PlyElement element;
    if (!(words >> element.name >> element.count)) return "an element without name or count";
    header.elements.push_back(element);
  } else if (keyword == "property") {
    if (header.elements.empty() || !ParseProperty(words, header.elements.back())) return "a property that is none";
  } else if (!keyword.empty()) {
    return "unknown header line '" + line.substr(0, 40) + "'";
  }
  return {};
}

template <typename T>
double Load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

std::size_t SizeOf(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      break;
  }
  return 8;
}

double LoadAs(PlyType type, const std::uint8_t* from) {
  switch (type) {
    case PlyType::kInt8:
      return Load<std::int8_t>(from);
    case PlyType::kUint8:
      return Load<std::uint8_t>(from);
    case PlyType::kInt16:
      return Load<std::int16_t>(from);
    case PlyType::kUint16:
      return Load<std::uint16_t>(from);
    case PlyType::kInt32:
      return Load<std::int32_t>(from);
    case PlyType::kUint32:
      return Load<std::uint32_t>(from);
    case PlyType::kFloat:
      return Load<float>(from);
    case PlyType::kDouble:
      break;
  }
  return Load<double>(from);
}

}  // namespace

Result<PlyHeader> ReadPlyHeader(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kLongestHeader));
  PlyHeader header;
  std::size_t at = 0;
  bool formatted = false;
  for (bool first = true;; first = false) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return Bad("its header has no end");
    std::string line(text.substr(at, end - at));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at = end + 1;
    if (first) {
      if (line != "ply") return Bad("it does not begin with 'ply'");
      continue;
    }
    if (line == "end_header") break;
    formatted = formatted || line.starts_with("format ");
    const std::string problem = ParseLine(line, header);
    if (!problem.empty()) return Bad(problem);
  }
  if (!formatted) return Bad("its header names no format");
  header.size_bytes = at;
  return header;
}

bool PlyReader::ReadAscii(double& value) {
  const auto* text = reinterpret_cast<const char*>(body_.data());
  while (at_ < body_.size() && (text[at_] == ' ' || text[at_] == '\n' || text[at_] == '\r' || text[at_] == '\t')) ++at_;
  const auto [end, code] = std::from_chars(text + at_, text + body_.size(), value);
  if (code != std::errc{}) return false;
  at_ = static_cast<std::size_t>(end - text);
  return true;
}

bool PlyReader::Read(PlyType type, double& value) {
  if (ascii_) return ReadAscii(value);
  const std::size_t size = SizeOf(type);
  if (body_.size() - at_ < size) return false;
  value = LoadAs(type, body_.data() + at_);
  at_ += size;
  return true;
}

bool PlyReader::ReadScalars(const PlyElement& element, std::vector<double>& values) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].is_list || !Read(element.properties[i].type, values[i])) return false;
  }
  return true;
}

bool PlyReader::ReadFace(const PlyElement& element, std::vector<std::uint32_t>& corners) {
  corners.clear();
  for (const PlyProperty& property : element.properties) {
    double count = 1;
    if (property.is_list && !Read(property.count_type, count)) return false;
    if (!(count >= 0 && count <= kMostCorners)) return false;
    const bool wanted = property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
    for (int k = 0; k < static_cast<int>(count); ++k) {
      double value = 0;
      if (!Read(property.type, value)) return false;
      if (!wanted) continue;
      if (!(value >= 0 && value < 4294967295.0)) return false;
      corners.push_back(static_cast<std::uint32_t>(value));
    }
  }
  return true;
}

bool PlyReader::Skip(const PlyElement& element) {
  std::vector<std::uint32_t> ignored;
  for (std::size_t i = 0; i < element.count; ++i) {
    if (!ReadFace(element, ignored)) return false;
  }
  return true;
}

}  // namespace striae::detail
