// The record's entries as JSON, as `show`, `results` and `history` print them (CONTRACT "Study commands").
#pragma once

#include <nlohmann/json.hpp>

#include "core/study.h"
#include "store/annotations.h"
#include "store/audit.h"
#include "store/entries.h"
#include "store/locks.h"
#include "store/reassign.h"
#include "store/users.h"
#include "store/visits.h"

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

nlohmann::json ToJson(const User& user);  ///< without anything about the passphrase but whether there is one
nlohmann::json ToJson(const Arm& arm);
nlohmann::json ToJson(const PlannedVisit& visit);
nlohmann::json ToJson(const VisitState& state);
nlohmann::json ToJson(const Treatment& treatment);
nlohmann::json ToJson(const StudyNote& note);
nlohmann::json ToJson(const DataQuery& query);
nlohmann::json ToJson(const Exclusion& exclusion);
nlohmann::json ToJson(const Lock& lock);
nlohmann::json ToJson(const Signature& signature);
nlohmann::json ToJson(const Reassignment& reassignment);

}  // namespace striae::store
