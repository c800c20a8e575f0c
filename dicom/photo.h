// The camera's photograph as a VL Photographic Image.
#pragma once

#include <cstdint>
#include <span>

#include "core/result.h"
#include "dicom/object.h"
#include "dicom/session_context.h"

namespace striae::dicom {

/// VL Photographic Image Storage (1.2.840.10008.5.1.4.1.1.77.1.4), JPEG Baseline: one frame that is the camera's file,
/// byte for byte (with a zero appended where its length is odd), or that file without its metadata when the context
/// says so. `number` (from 1) becomes the Instance Number.
///
/// Pixels are as the sensor read them; DICOM has no EXIF Orientation. For head poses, where the subject faces the
/// camera, Patient Orientation says which way they lie; otherwise it is empty. A camera that was turned is also named
/// in Image Comments.
/// kBadImage where InspectJpeg refuses the file; kUsage for a pseudonym that DICOM cannot hold.
Result<Object> EncodePhoto(const SessionContext& context, const Capture& capture, std::span<const std::uint8_t> jpeg,
                           int number);

}  // namespace striae::dicom
