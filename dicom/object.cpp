#include "dicom/object.h"

#include <stdexcept>

namespace striae::dicom {

std::string_view ToString(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::kPhoto:
      return "photo";
    case ObjectKind::kSurface:
      return "surface";
    case ObjectKind::kMeasurements:
      return "measurements";
  }
  throw std::logic_error("ObjectKind: no such kind");
}

}  // namespace striae::dicom
