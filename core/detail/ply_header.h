// The header of a PLY file and a bounds-checked reader of its body. All sizes come from outside: nothing is trusted.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::detail {

/// Of surfaces that have none, written or read: a light grey, and full modulation.
inline constexpr Rgb8 kUnsaidColour{200, 200, 200};
inline constexpr float kUnsaidQuality = 1.0F;

/// The comment line that keeps the sensor's size begins so.
inline constexpr std::string_view kSensorComment = "striae sensor ";

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool ascii = false;
  std::vector<std::string> comments;
  std::vector<PlyElement> elements;
  std::size_t size_bytes = 0;
};

Result<PlyHeader> ReadPlyHeader(std::span<const std::uint8_t> bytes);

/// Reads the body row by row; every function returns false at a premature end or a value that cannot be.
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::span<const std::uint8_t> body) : ascii_(header.ascii), body_(body) {}

  /// One row of scalars; false too where the element has a list.
  bool ReadScalars(const PlyElement& element, std::vector<double>& values);
  /// One row whose list property holds the corners (other scalars are skipped); at most 255 corners.
  bool ReadFace(const PlyElement& element, std::vector<std::uint32_t>& corners);
  bool Skip(const PlyElement& element);

 private:
  bool Read(PlyType type, double& value);
  bool ReadAscii(double& value);

  bool ascii_;
  std::span<const std::uint8_t> body_;
  std::size_t at_ = 0;
};

}  // namespace striae::detail
