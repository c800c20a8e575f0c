// From any one thing to all that it came from and all that came from it.
#include "store/detail/about.h"
#include "store/detail/impl.h"
#include "store/detail/read.h"
#include "store/json.h"

namespace striae::store {
namespace {

using detail::Guarded;
using detail::RowView;
using detail::Unwrap;
using nlohmann::json;

template <typename IdType>
IdType Key(const Record::Found& found) {
  return Unwrap(IdType::Parse(found.id));
}

std::string OneText(detail::Database& database, const std::string& sql, const std::string& id) {
  return database
      .One(
          sql, [](const RowView& row) { return row.Text(0); }, id)
      .value_or("");
}

/// One record being described; each function adds what it knows about one kind of thing.
class Describer {
 public:
  Describer(Record& record, detail::Database& database) : record_(record), database_(database) {}

  json Of(const Record::Found& found) {
    const std::string& entity = found.entity;
    if (entity == "subject") return OfSubject(Unwrap(record_.SubjectById(Key<SubjectId>(found))));
    if (entity == "session") return OfSession(Unwrap(record_.SessionById(Key<SessionId>(found))));
    if (entity == "capture") return OfCapture(Unwrap(record_.CaptureById(Key<CaptureId>(found))));
    if (entity == "outcome") return OfOutcome(Unwrap(record_.OutcomeById(Key<ReportId>(found))));
    if (entity == "measurement") return OfMeasurement(found.id);
    if (entity == "device") return OfDevice(detail::GetDevice(database_, Key<DeviceId>(found)));
    if (entity == "visit") return OfVisit(Unwrap(record_.VisitById(Key<VisitId>(found))));
    if (entity == "object") return OfObject(found.id);
    return OfRow(found);
  }

 private:
  json Place(const SessionId& id) {
    const Session session = Unwrap(record_.SessionById(id));
    return {{"session", id.ToString()},
            {"opened_at", session.opened_at.ToString()},
            {"subject", Unwrap(record_.SubjectById(session.subject)).pseudonym},
            {"visit", Unwrap(record_.VisitById(session.visit)).name}};
  }

  json OfSubject(const Subject& subject) {
    json object = ToJson(subject);
    object["type"] = "subject";
    object["visits"] = json::array();
    for (const Visit& visit : Unwrap(record_.Visits(subject.id))) object["visits"].push_back(visit.name);
    object["sessions"] = json::array();
    for (const Session& session : Unwrap(record_.Sessions(subject.id))) {
      object["sessions"].push_back(Place(session.id));
    }
    return object;
  }

  json OfVisit(const Visit& visit) {
    json object = {{"type", "visit"}, {"id", visit.id.ToString()}, {"name", visit.name}, {"sessions", json::array()}};
    object["subject"] = Unwrap(record_.SubjectById(visit.subject)).pseudonym;
    for (const Session& session : Unwrap(record_.Sessions(visit.subject))) {
      if (session.visit == visit.id) object["sessions"].push_back(Place(session.id));
    }
    return object;
  }

  json OfSession(const Session& session) {
    json object = ToJson(session);
    object["type"] = "session";
    object.update(Place(session.id));
    object["captures"] = json::array();
    for (const Capture& capture : Unwrap(record_.Captures(session.id))) {
      json entry = ToJson(capture);
      entry["outcomes"] = json::array();
      for (const Outcome& outcome : Unwrap(record_.Outcomes(capture.id))) entry["outcomes"].push_back(Brief(outcome));
      object["captures"].push_back(std::move(entry));
    }
    return object;
  }

  static json Brief(const Outcome& outcome) {
    json object = {{"id", outcome.id.ToString()},
                   {"analysis", outcome.analysis},
                   {"state", outcome.failure ? "failed" : "ok"},
                   {"at", outcome.at.ToString()}};
    if (outcome.failure) object["reason"] = outcome.failure->Describe();
    return object;
  }

  json OfCapture(const Capture& capture) {
    json object = ToJson(capture);
    object["type"] = "capture";
    object.update(Place(capture.session));
    object["object"] = std::filesystem::relative(record_.objects().PathOf(capture.sha256), record_.folder()).string();
    const auto outline = Unwrap(record_.LatestOutline(capture.id));
    object["outline"] = outline ? ToJson(*outline) : json();
    object["derived"] = json::array();
    for (const Derived& derived : Unwrap(record_.DerivedOf(capture.id))) object["derived"].push_back(ToJson(derived));
    object["outcomes"] = json::array();
    for (const Outcome& outcome : Unwrap(record_.Outcomes(capture.id))) object["outcomes"].push_back(ToJson(outcome));
    return object;
  }

  json OfOutcome(const Outcome& outcome) {
    json object = ToJson(outcome);
    object["type"] = "report";
    object.update(Place(Unwrap(record_.CaptureById(outcome.capture)).session));
    object["superseded_by"] = nullptr;
    const std::string newer = OneText(database_, "SELECT id FROM outcome WHERE supersedes = ?", outcome.id.ToString());
    if (!newer.empty()) object["superseded_by"] = newer;
    const auto ids = database_.Rows(
        "SELECT id FROM measurement WHERE outcome_id = ? ORDER BY number",
        [](const RowView& row) { return row.Text(0); }, outcome.id);
    for (std::size_t i = 0; i < ids.size(); ++i) object["measurements"].at(i)["id"] = ids[i];
    object["leads_to"] = Origins(outcome.report.provenance);
    return object;
  }

  /// Each input of a derived value with the entities that have these bytes.
  json Origins(const Provenance& provenance) {
    json list = json::array();
    for (const ProvenanceInput& input : provenance.inputs) {
      json entry = Holders(input.sha256.ToString());
      entry["name"] = input.name;
      entry["sha256"] = input.sha256.ToString();
      list.push_back(std::move(entry));
    }
    return list;
  }

  json Holders(const std::string& sha256) {
    json object = json::object();
    const auto add = [&](const char* name, const std::string& sql) {
      const auto ids = database_.Rows(
          sql, [](const RowView& row) { return row.Text(0); }, sha256);
      if (!ids.empty()) object[name] = ids;
    };
    add("captures", "SELECT id FROM capture WHERE sha256 = ? ORDER BY imported_at, id");
    add("calibrations", "SELECT id FROM calibration WHERE sha256 = ? ORDER BY valid_from, id");
    add("outlines", "SELECT id FROM outline WHERE sha256 = ? ORDER BY added_at, id");
    add("derived", "SELECT id FROM derived WHERE sha256 = ?1 OR object = ?1 ORDER BY made_at, id");
    return object;
  }

  json OfMeasurement(const std::string& id) {
    const std::string owner = OneText(database_, "SELECT outcome_id FROM measurement WHERE id = ?", id);
    json report = OfOutcome(Unwrap(record_.OutcomeById(Unwrap(ReportId::Parse(owner)))));
    json object;
    for (json& measurement : report["measurements"]) {
      if (measurement.value("id", "") == id) object = measurement;
    }
    report.erase("measurements");
    object["type"] = "measurement";
    object["report"] = std::move(report);
    return object;
  }

  json OfDevice(const Device& device) {
    json object = ToJson(device);
    object["type"] = "device";
    object["calibrations"] = json::array();
    for (const auto& calibration : Unwrap(record_.Calibrations(device.id))) {
      object["calibrations"].push_back(ToJson(calibration));
    }
    return object;
  }

  json OfObject(const std::string& sha256) {
    json object = Holders(sha256);
    object["type"] = "object";
    object["id"] = sha256;
    const Sha256 key = Unwrap(Sha256::Parse(sha256));
    object["unaltered"] = record_.objects().Verify(key).has_value();
    object["reports"] = database_.Rows(
        "SELECT id FROM outcome WHERE instr(report, ?) > 0 ORDER BY at, id",
        [](const RowView& row) { return row.Text(0); }, sha256);
    return object;
  }

  json OfRow(const Record::Found& found) {
    const auto read = [](const RowView& row) {
      json object = json::object();
      for (int i = 0; i < row.size(); ++i) {
        object[row.NameOf(i)] = row.IsNull(i) ? json() : json(row.Text(i));
      }
      return object;
    };
    json object = database_.One("SELECT * FROM " + found.entity + " WHERE id = ?", read, found.id).value_or(json());
    object["type"] = found.entity;
    if (object.contains("sha256")) {
      object["reports"] = database_.Rows(
          "SELECT id FROM outcome WHERE instr(report, ?) > 0 ORDER BY at, id",
          [](const RowView& row) { return row.Text(0); }, object["sha256"].get<std::string>());
    }
    return object;
  }

  Record& record_;
  detail::Database& database_;
};

}  // namespace

Result<json> Record::Describe(std::string_view id) {
  return Guarded([&] {
    const Found found = Unwrap(Find(id));
    json object = Describer(*this, impl_->database).Of(found);
    object.update(detail::About(*this, found));
    return object;
  });
}

}  // namespace striae::store
