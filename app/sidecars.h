// XMP sidecars beside photographs that were imported from files.
#pragma once

#include <filesystem>

#include "core/result.h"
#include "core/study.h"
#include "store/record.h"

namespace striae::app {

/// Writes "<photograph>.xmp" with the subject's pseudonym, the session and the ids. One that Striae wrote before is
/// replaced; another program's is refused (kRecordRefused) and stays as it is.
Status WriteSidecar(store::Record& record, const Capture& capture, const std::filesystem::path& photograph);

}  // namespace striae::app
