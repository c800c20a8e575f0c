// Notes and deviations, about anything in the record.
#include "store/annotations.h"
#include "store/detail/require.h"
#include "store/detail/strike.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr const char* kNotes =
    "SELECT id, entity, entity_id, kind, date, text, by, at, supersedes FROM note n WHERE in_error = 0 AND NOT EXISTS "
    "(SELECT 1 FROM note newer WHERE newer.supersedes = n.id)";

StudyNote ReadNote(const RowView& row) {
  StudyNote note{row.Key<NoteId>(0),
                 {row.Text(1), row.Text(2)},
                 row.Text(3) == "deviation",
                 row.Day(4),
                 row.Text(5),
                 row.Text(6),
                 row.Time(7),
                 {}};
  if (!row.IsNull(8)) note.supersedes = row.Key<NoteId>(8);
  return note;
}

StudyNote InForce(Database& database, const NoteId& id) {
  auto found = database.One(std::string(kNotes) + " AND n.id = ?", ReadNote, id);
  if (!found) Refuse(ErrorCode::kNotFound, "no note " + id.ToString() + " in force; see 'striae note list'");
  return *std::move(found);
}

}  // namespace

void detail::InsertNote(Change& change, const StudyNote& n, bool in_error, const std::string& reason,
                        const Stamp& stamp) {
  change.Insert("note",
                {{"id", ToValue(n.id)},
                 {"entity", ToValue(n.about.entity)},
                 {"entity_id", ToValue(n.about.id)},
                 {"kind", ToValue(n.deviation ? "deviation" : "note")},
                 {"date", ToValue(n.date)},
                 {"text", ToValue(n.text)},
                 {"in_error", ToValue(in_error ? 1 : 0)},
                 {"by", ToValue(stamp.user)},
                 {"at", ToValue(stamp.now)},
                 {"supersedes", ToValue(n.supersedes)}},
                reason);
}

Status AddNote(Record& record, const StudyNote& note, const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireText(note.text, "a note");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    detail::Unwrap(record.Find(note.about.id));
    if (note.supersedes) {
      detail::RequireReason(reason, "a correction");
      InForce(database, *note.supersedes);
    }
    detail::InsertNote(change, note, false, reason, stamp);
    change.Commit();
  });
}

Status StrikeNote(Record& record, const NoteId& id, const NoteId& new_id, const std::string& reason,
                  const Stamp& stamp) {
  return detail::Strike(record, InForce, detail::InsertNote, id, new_id, reason, stamp);
}

Result<std::vector<StudyNote>> Notes(Record& record, std::optional<std::string> about) {
  return Guarded([&] {
    return Access::Of(record).database.Rows(
        std::string(kNotes) + " AND (?1 IS NULL OR entity_id = ?1) ORDER BY date, at, id", ReadNote, about);
  });
}

}  // namespace striae::store
