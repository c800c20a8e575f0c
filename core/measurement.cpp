#include "core/measurement.h"

#include <cmath>
#include <set>

namespace striae {
namespace {

using nlohmann::json;

json CodeToJson(const Code& code) {
  return {{"scheme", code.scheme}, {"value", code.value}, {"meaning", code.meaning}};
}

Code CodeFromJson(const json& object) {
  return {object.at("scheme").get<std::string>(), object.at("value").get<std::string>(),
          object.at("meaning").get<std::string>()};
}

Measurement ReadMeasurement(const json& object) {
  Measurement m;
  m.name = object.at("name").get<std::string>();
  m.value = object.at("value").get<double>();
  m.unit = object.at("unit").get<std::string>();
  m.uncertainty = object.at("uncertainty").get<double>();
  const std::string status = object.at("status").get<std::string>();
  m.status = status == "ok" ? Measurement::Status::kOk : Measurement::Status::kFlagged;
  m.reason = object.value("reason", "");
  m.code = CodeFromJson(object.at("code"));
  for (const json& code : object.value("equivalents", json::array())) m.equivalents.push_back(CodeFromJson(code));
  return m;
}

}  // namespace

void FlagAll(AnalysisReport& report, const std::string& reason) {
  for (Measurement& measurement : report.measurements) {
    measurement.status = Measurement::Status::kFlagged;
    measurement.reason += (measurement.reason.empty() ? "" : "; ") + reason;
  }
}

const Measurement* AnalysisReport::Find(std::string_view name) const {
  for (const Measurement& measurement : measurements) {
    if (measurement.name == name) return &measurement;
  }
  return nullptr;
}

json ToJson(const Measurement& m) {
  json object = {{"name", m.name},
                 {"value", m.value},
                 {"unit", m.unit},
                 {"uncertainty", m.uncertainty},
                 {"status", m.status == Measurement::Status::kOk ? "ok" : "flagged"},
                 {"code", CodeToJson(m.code)}};
  if (!m.equivalents.empty()) {
    for (const Code& code : m.equivalents) object["equivalents"].push_back(CodeToJson(code));
  }
  if (m.status == Measurement::Status::kFlagged) object["reason"] = m.reason;
  return object;
}

json ToJson(const AnalysisReport& report) {
  json object = {{"analysis", report.analysis},
                 {"version", report.version},
                 {"software", {{"name", report.provenance.software}, {"version", report.provenance.version}}},
                 {"inputs", json::array()},
                 {"parameters", report.provenance.parameters},
                 {"measurements", json::array()}};
  for (const auto& input : report.provenance.inputs) {
    object["inputs"].push_back({{"name", input.name}, {"sha256", input.sha256.ToString()}});
  }
  for (const auto& measurement : report.measurements) object["measurements"].push_back(ToJson(measurement));
  for (const auto& [key, value] : report.details.items()) object[key] = value;
  return object;
}

Result<Measurement> MeasurementFromJson(const json& object) {
  try {
    Measurement m = ReadMeasurement(object);
    if (!std::isfinite(m.value) || !std::isfinite(m.uncertainty) || m.uncertainty < 0) {
      return Fail(ErrorCode::kBadFile, "measurement '" + m.name + "' has a value that is not finite");
    }
    return m;
  } catch (const json::exception& e) {
    return Fail(ErrorCode::kBadFile, std::string("not a measurement: ") + e.what());
  }
}

Result<AnalysisReport> AnalysisReportFromJson(const json& object) {
  static const std::set<std::string> kOwn = {"analysis", "version", "software", "inputs", "parameters", "measurements"};
  try {
    AnalysisReport report;
    report.analysis = object.at("analysis").get<std::string>();
    report.version = object.at("version").get<std::string>();
    report.provenance.software = object.at("software").at("name").get<std::string>();
    report.provenance.version = object.at("software").at("version").get<std::string>();
    report.provenance.parameters = object.at("parameters");
    for (const json& input : object.at("inputs")) {
      auto sha256 = Sha256::Parse(input.at("sha256").get<std::string>());
      if (!sha256) return Fail(sha256.error());
      report.provenance.inputs.push_back({input.at("name").get<std::string>(), *sha256});
    }
    for (const json& entry : object.at("measurements")) {
      auto measurement = MeasurementFromJson(entry);
      if (!measurement) return Fail(measurement.error());
      report.measurements.push_back(*std::move(measurement));
    }
    for (const auto& [key, value] : object.items()) {
      if (!kOwn.contains(key)) report.details[key] = value;
    }
    return report;
  } catch (const json::exception& e) {
    return Fail(ErrorCode::kBadFile, std::string("not an analysis report: ") + e.what());
  }
}

}  // namespace striae
