// Values that are kept as JSON text within a column.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/provenance.h"
#include "core/study.h"

namespace striae::store::detail {

nlohmann::json MetadataToJson(const PhotoMetadata& metadata);
PhotoMetadata MetadataFromJson(const nlohmann::json& json);
nlohmann::json PreflightToJson(const std::vector<PreflightItem>& items);
std::vector<PreflightItem> PreflightFromJson(const nlohmann::json& json);
nlohmann::json ProvenanceToJson(const Provenance& provenance);
Provenance ProvenanceFromJson(const nlohmann::json& json);

/// Compact text; what is not UTF-8 becomes U+FFFD.
std::string Dump(const nlohmann::json& json);

/// A UUID that follows from its parts, for rows that belong to a row with an id of its own: the first 16 bytes of the
/// SHA-256 over the parts, marked as version 8 (RFC 9562).
Uuid UuidFrom(std::initializer_list<std::string> parts);

ErrorCode ErrorCodeFrom(std::string_view text);

}  // namespace striae::store::detail
