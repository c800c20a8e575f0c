// The record's entries as JSON, as `show`, `results` and `history` print them (CONTRACT "Study commands").
#pragma once

#include <nlohmann/json.hpp>

#include "core/study.h"
#include "store/audit.h"
#include "store/entries.h"

namespace striae::store {

nlohmann::json ToJson(const Study& study);
nlohmann::json ToJson(const Site& site);
nlohmann::json ToJson(const Subject& subject);  ///< {"id", "pseudonym", "consent_given"|null, "consent_withdrawn"|null}
nlohmann::json ToJson(const Device& device);
nlohmann::json ToJson(const CalibrationReference& calibration);
nlohmann::json ToJson(const Session& session);
nlohmann::json ToJson(
    const Capture& capture);  ///< {"id", "sha256", "role", ..., "photograph": {...}, "preflight": [...]}
nlohmann::json ToJson(const StoredOutline& outline);
nlohmann::json ToJson(const Derived& derived);
nlohmann::json ToJson(const Outcome& outcome);  ///< the analysis report with "id", "capture", "state": "ok"|"failed"
/// {"id", "subject", "visit", "session", "capture", "role", "analysis", ... and the measurement's own fields}
nlohmann::json ToJson(const ResultRow& row);
nlohmann::json ToJson(const AuditRow& row);
nlohmann::json ToJson(const CheckReport& report);
nlohmann::json ToJson(const Overview& overview);

}  // namespace striae::store
