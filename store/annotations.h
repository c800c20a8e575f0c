// What people say about the data: treatments, notes, queries and exclusions. All are added only; a correction
// supersedes and needs a reason, the entry before stays readable.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/study.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

using TreatmentId = Id<struct TreatmentTag>;
using NoteId = Id<struct NoteTag>;
using QueryId = Id<struct QueryTag>;
using QueryStepId = Id<struct QueryStepTag>;
using ExclusionId = Id<struct ExclusionTag>;

struct Treatment {
  TreatmentId id;
  SubjectId subject;
  Date date;
  std::string text;  ///< "compression bandage, 40 mmHg"
  std::string by;    ///< who entered it
  UtcTime at;        ///< when it was entered
  std::optional<TreatmentId> supersedes;
};

/// A note on anything in the record; a deviation is a note that the study reports.
struct StudyNote {
  NoteId id;
  Record::Found about;
  bool deviation = false;
  Date date;
  std::string text, by;
  UtcTime at;
  std::optional<NoteId> supersedes;
};

enum class QueryState { kOpen, kAnswered, kClosed };
std::string_view ToString(QueryState state);

struct QueryStep {
  QueryState state = QueryState::kOpen;
  std::string text, by;
  UtcTime at;
};
/// A question about the data and its answers.
struct DataQuery {
  QueryId id;
  Record::Found about;
  std::string text, by;
  UtcTime at;
  QueryState state = QueryState::kOpen;
  std::vector<QueryStep> steps;
};

/// A capture, or one quantity of it, that does not count. It stays in the record and in `results`, marked.
struct Exclusion {
  ExclusionId id;
  CaptureId capture;
  std::optional<std::string> analysis, name;  ///< none: the whole capture; else one measured quantity, also when it is
                                              ///< computed again
  std::string reason, by;
  UtcTime at;
};

/// id, subject, date and text are taken from the argument; by and at from the stamp. With `supersedes` a reason is
/// needed, and the entry before must be in force.
Status AddTreatment(Record& record, const Treatment& treatment, const std::string& reason, const Stamp& stamp);
/// Marks an entry that should not be there as entered in error.
Status StrikeTreatment(Record& record, const TreatmentId& id, const TreatmentId& new_id, const std::string& reason,
                       const Stamp& stamp);
/// In force, by date.
Result<std::vector<Treatment>> Treatments(Record& record, std::optional<SubjectId> subject = std::nullopt);

/// As AddTreatment, for `about` as Record::Find gave it.
Status AddNote(Record& record, const StudyNote& note, const std::string& reason, const Stamp& stamp);
Status StrikeNote(Record& record, const NoteId& id, const NoteId& new_id, const std::string& reason,
                  const Stamp& stamp);
/// In force, by date; about one thing (by its id), or all.
Result<std::vector<StudyNote>> Notes(Record& record, std::optional<std::string> about = std::nullopt);

Status OpenQuery(Record& record, const QueryId& id, const Record::Found& about, const std::string& text,
                 const Stamp& stamp);
/// Only an open query is answered; an answered or open one is closed; an answered or closed one is opened again.
/// kRecordRefused otherwise. Each step needs a text.
Status StepQuery(Record& record, const QueryId& id, QueryState next, const std::string& text, const Stamp& stamp);
Result<std::vector<DataQuery>> Queries(Record& record, bool with_closed = false,
                                       std::optional<std::string> about = std::nullopt);

/// `target`: a capture or a measurement, as Record::Find gave it. Needs a reason; kRecordRefused when excluded already.
Status Exclude(Record& record, const ExclusionId& id, const Record::Found& target, const std::string& reason,
               const Stamp& stamp);
/// Takes it back, with a reason.
Status Include(Record& record, const ExclusionId& id, const Record::Found& target, const std::string& reason,
               const Stamp& stamp);
/// In force.
Result<std::vector<Exclusion>> Exclusions(Record& record, std::optional<CaptureId> capture = std::nullopt);

}  // namespace striae::store
