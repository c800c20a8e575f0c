// A surface as PLY on the disk.
#pragma once

#include <filesystem>

#include "core/result.h"
#include "core/surface.h"

namespace striae::app {

/// Before anything is computed: kIo when the folder is not there or the path is a folder.
Status CheckWritable(const std::filesystem::path& path);

/// In pieces while it is encoded: the file is not in memory a second time.
Status WritePly(const Surface& surface, const std::filesystem::path& path);

}  // namespace striae::app
