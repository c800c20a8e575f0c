// Whole files for tests: a file that cannot be read is empty, so that the comparison that follows fails.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace striae::testing {

std::vector<std::uint8_t> ReadBytes(const std::filesystem::path& path);
std::string ReadText(const std::filesystem::path& path);

/// Makes the folder when it is not there.
void WriteBytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes);

}  // namespace striae::testing
