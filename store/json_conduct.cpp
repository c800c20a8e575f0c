// Users, plan, annotations, locks and reassignments as JSON.
#include "store/json.h"

namespace striae::store {
namespace {

using nlohmann::json;

template <typename T>
json TextOrNull(const std::optional<T>& value) {
  return value ? json(value->ToString()) : json();
}

json About(const Record::Found& found) { return {{"entity", found.entity}, {"id", found.id}}; }

}  // namespace

json ToJson(const User& user) {
  return {{"id", user.id.ToString()},    {"name", user.name},     {"full_name", user.full_name},
          {"role", ToString(user.role)}, {"active", user.active}, {"has_passphrase", user.has_passphrase}};
}

json ToJson(const Arm& arm) { return {{"id", arm.id.ToString()}, {"name", arm.name}, {"title", arm.title}}; }

json ToJson(const PlannedVisit& visit) {
  return {{"id", visit.id.ToString()},
          {"visit", visit.name},
          {"arm_id", TextOrNull(visit.arm)},
          {"day", visit.day},
          {"window", {visit.window_from, visit.window_to}}};
}

json ToJson(const VisitState& state) {
  return {{"subject", state.subject.pseudonym},
          {"visit", state.visit.name},
          {"day", state.visit.day},
          {"state", ToString(state.state)},
          {"earliest", TextOrNull(state.earliest)},
          {"target", TextOrNull(state.target)},
          {"latest", TextOrNull(state.latest)},
          {"held", TextOrNull(state.held)}};
}

json ToJson(const Treatment& treatment) {
  return {{"id", treatment.id.ToString()},
          {"subject_id", treatment.subject.ToString()},
          {"date", treatment.date.ToString()},
          {"text", treatment.text},
          {"by", treatment.by},
          {"at", treatment.at.ToString()},
          {"supersedes", TextOrNull(treatment.supersedes)}};
}

json ToJson(const StudyNote& note) {
  return {{"id", note.id.ToString()},
          {"about", About(note.about)},
          {"kind", note.deviation ? "deviation" : "note"},
          {"date", note.date.ToString()},
          {"text", note.text},
          {"by", note.by},
          {"at", note.at.ToString()},
          {"supersedes", TextOrNull(note.supersedes)}};
}

json ToJson(const DataQuery& query) {
  json object = {
      {"id", query.id.ToString()}, {"about", About(query.about)},    {"text", query.text},    {"by", query.by},
      {"at", query.at.ToString()}, {"state", ToString(query.state)}, {"steps", json::array()}};
  for (const QueryStep& step : query.steps) {
    object["steps"].push_back(
        {{"state", ToString(step.state)}, {"text", step.text}, {"by", step.by}, {"at", step.at.ToString()}});
  }
  return object;
}

json ToJson(const Exclusion& exclusion) {
  return {{"id", exclusion.id.ToString()},
          {"capture", exclusion.capture.ToString()},
          {"analysis", exclusion.analysis ? json(*exclusion.analysis) : json()},
          {"name", exclusion.name ? json(*exclusion.name) : json()},
          {"reason", exclusion.reason},
          {"by", exclusion.by},
          {"at", exclusion.at.ToString()}};
}

json ToJson(const Lock& lock) {
  return {{"id", lock.id.ToString()},
          {"about", About(lock.target)},
          {"reason", lock.reason},
          {"by", lock.by},
          {"at", lock.at.ToString()}};
}

json ToJson(const Signature& signature) {
  return {{"id", signature.id.ToString()},
          {"about", About(signature.target)},
          {"meaning", ToString(signature.meaning)},
          {"signer", signature.signer},
          {"role", signature.role},
          {"at", signature.at.ToString()},
          {"content_sha256", signature.content.ToString()},
          {"state", ToString(signature.state)}};
}

json ToJson(const Reassignment& move) {
  return {{"moved", About(move.moved)},
          {"from", move.from_id},
          {"to", move.to_id},
          {"from_subject_id", move.from_subject.ToString()},
          {"to_subject_id", move.to_subject.ToString()},
          {"reason", move.reason},
          {"by", move.by},
          {"at", move.at.ToString()}};
}

}  // namespace striae::store
