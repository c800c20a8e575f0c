// RFC 4648 base64 with padding, for data URIs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace striae::report::detail {

std::string Base64(std::span<const std::uint8_t> bytes);

}  // namespace striae::report::detail
