// A measured surface as Encapsulated STL.
#pragma once

#include <string>

#include "core/result.h"
#include "core/surface.h"
#include "dicom/object.h"
#include "dicom/session_context.h"
#include "dicom/thin.h"

namespace striae::dicom {

/// Encapsulated STL Storage (1.2.840.10008.5.1.4.1.1.104.3), modality M3D, mm, camera frame, one series and one frame
/// of reference a capture. `thinned` comes from ThinSurface; its step and deviation stand in Document Title and Series
/// Description. `photo` is the photograph it came from (Source Instance Sequence, Referenced Series Sequence).
/// `software_version` is that of the reconstruction. kUsage when there are more than kMostFaces faces, none, or
/// `photo` is of another DICOM study.
Result<Object> EncodeSurface(const SessionContext& context, const Capture& capture, const ThinnedSurface& thinned,
                             const ObjectReference& photo, const std::string& software_version);

}  // namespace striae::dicom
