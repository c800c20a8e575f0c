// Reading and writing whole files. A write is complete or absent: temporary file, fsync, rename.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/hex.h"
#include "core/result.h"
#include "store/objects.h"

namespace striae::app {

/// kNotFound with what to check when absent; kIo otherwise.
Result<std::vector<std::uint8_t>> ReadFile(const std::filesystem::path& path);
Result<std::string> ReadText(const std::filesystem::path& path);

/// Writes beside the target and renames over it; on any failure the target is as it was and no temporary stays.
Status WriteFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Status WriteText(const std::filesystem::path& path, std::string_view text);

/// SHA-256 of bytes, the same that names an object of the record.
using store::HashOf;

}  // namespace striae::app
