// DICOM UIDs without a registered root: "2.25." and a UUID as a decimal number (PS3.5 B.2).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/id.h"

namespace striae::dicom {

/// 2.25.<decimal>, at most 44 characters.
std::string UidOf(const Uuid& uuid);

/// The UID that belongs to `bytes`: the UUID (version 8, RFC 9562) made of the first 128 bits of their SHA-256. Equal
/// bytes have equal UIDs on every machine; changed bytes have another one.
std::string UidOfContent(std::span<const std::uint8_t> bytes);
/// The same for a name such as "study/<session>/<subject>".
std::string UidOfName(std::string_view name);

}  // namespace striae::dicom
