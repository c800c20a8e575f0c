// A DICOM object as bytes, and how others refer to it. DICOM's own names are used (PS3.3).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace striae::dicom {

enum class ObjectKind { kPhoto, kSurface, kMeasurements };
/// "photo", "surface", "measurements".
std::string_view ToString(ObjectKind kind);

/// What another object needs to point at this one.
struct ObjectReference {
  ObjectKind kind = ObjectKind::kPhoto;
  std::string study_uid, series_uid, sop_class_uid, sop_instance_uid;
  bool operator==(const ObjectReference&) const = default;
};

struct Object {
  ObjectReference reference;
  std::vector<std::uint8_t> bytes;  ///< a whole file: preamble, file meta information, data set
};

}  // namespace striae::dicom
