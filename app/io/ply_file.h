// A surface as PLY on the disk.
#pragma once

#include <filesystem>
#include <functional>

#include "core/ply_layout.h"
#include "core/result.h"

namespace striae::app {

/// Before anything is computed: kIo when the folder is not there or the path is a folder.
Status CheckWritable(const std::filesystem::path& path);

/// In pieces while it is encoded (EncodePly of a Surface or a SensorSurface): the file is not in memory a second time.
/// `expected` bytes, as WriteFile.
Status WritePly(const std::function<bool(const PieceSink&)>& encode, const std::filesystem::path& path,
                std::size_t expected = 0);

}  // namespace striae::app
