// A finished data set -> the object's UID and bytes.
#pragma once

#include "core/result.h"
#include "dicom/detail/dataset.h"
#include "dicom/object.h"

namespace striae::dicom::detail {

/// Gives the data set the UID of its own content (UidOfContent of the encoded data set without a SOP Instance UID), so
/// that the same content keeps its UID for ever and changed content never goes under an old one; a PACS keeps the
/// first object it got under a UID and says "success" to the second. Then encodes it as a file.
Result<Object> Finish(ObjectKind kind, DcmFileFormat& file, E_TransferSyntax transfer_syntax);

}  // namespace striae::dicom::detail
