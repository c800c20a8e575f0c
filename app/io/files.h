// Reading and writing whole files. A write is complete or absent: temporary file, rename.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// kDisk waits until the disk has the bytes: for what cannot be made again. kSystem leaves them to the operating system
/// (a file of 137 MB is there in 40 instead of 90 ms): for what one command makes again from the photograph; a loss of
/// power within half a minute may leave it empty.
enum class Kept { kDisk, kSystem };

/// Takes the next bytes of a file; false when they cannot be written, and then no more may come.
using ByteSink = std::function<bool(std::span<const std::uint8_t>)>;

/// Writes beside the target and renames over it; on any failure the target is as it was and no temporary stays.
Status WriteFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes, Kept kept = Kept::kDisk);
/// The same for bytes that come in pieces from `produce`. Room for `expected` bytes is asked for before the first is
/// written, so that a full disk is known at once; the file is as long as what came, whatever was expected.
Status WriteFile(const std::filesystem::path& path, const std::function<bool(const ByteSink&)>& produce, Kept kept,
                 std::size_t expected = 0);
Status WriteText(const std::filesystem::path& path, std::string_view text);

/// SHA-256 of bytes, the same that names an object of the record.
using store::HashOf;

}  // namespace striae::app
