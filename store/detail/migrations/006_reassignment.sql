-- A photograph or a session that was logged under the wrong subject is moved: the only way to change where it
-- belongs is beside a row that says from where to where, and why.
CREATE TABLE reassignment (id TEXT PRIMARY KEY NOT NULL, entity TEXT NOT NULL CHECK (entity IN ('capture', 'session')),
  entity_id TEXT NOT NULL, from_id TEXT NOT NULL, to_id TEXT NOT NULL, from_subject TEXT NOT NULL REFERENCES subject(id),
  to_subject TEXT NOT NULL REFERENCES subject(id), from_visit TEXT NOT NULL REFERENCES visit(id),
  to_visit TEXT NOT NULL REFERENCES visit(id), reason TEXT NOT NULL CHECK (reason <> ''), by TEXT NOT NULL,
  at TEXT NOT NULL) STRICT;
CREATE INDEX reassignment_entity ON reassignment (entity_id);
-- Outcomes of the capture up to that number were computed for its old place.
CREATE TABLE stale_mark (id TEXT PRIMARY KEY NOT NULL, capture_id TEXT NOT NULL REFERENCES capture(id),
  outcomes INTEGER NOT NULL, reassignment_id TEXT NOT NULL REFERENCES reassignment(id)) STRICT;
CREATE INDEX stale_mark_capture ON stale_mark (capture_id);
--guard reassignment
--guard stale_mark
DROP TRIGGER capture_no_update;
CREATE TRIGGER capture_no_update BEFORE UPDATE OF id, sha256, file_name, media_type, size_bytes, imported_at, metadata,
  preflight ON capture BEGIN SELECT RAISE(ABORT, 'capture rows are never changed here'); END;
CREATE TRIGGER capture_moves BEFORE UPDATE OF session_id ON capture WHEN NEW.session_id <> OLD.session_id
  AND NOT EXISTS (SELECT 1 FROM reassignment WHERE entity = 'capture' AND entity_id = OLD.id
    AND from_id = OLD.session_id AND to_id = NEW.session_id)
BEGIN SELECT RAISE(ABORT, 'a capture changes its session by a reassignment only'); END;
CREATE TRIGGER capture_number BEFORE UPDATE OF number ON capture WHEN NEW.number <> OLD.number
  AND NOT EXISTS (SELECT 1 FROM reassignment WHERE entity = 'capture' AND entity_id = OLD.id)
BEGIN SELECT RAISE(ABORT, 'a capture changes its number by a reassignment only'); END;
DROP TRIGGER session_no_update;
CREATE TRIGGER session_no_update BEFORE UPDATE OF id, operator, opened_at, site_time_zone ON session BEGIN
  SELECT RAISE(ABORT, 'session rows are never changed here'); END;
CREATE TRIGGER session_moves BEFORE UPDATE OF subject_id, visit_id ON session
  WHEN (NEW.subject_id <> OLD.subject_id OR NEW.visit_id <> OLD.visit_id)
  AND NOT EXISTS (SELECT 1 FROM reassignment WHERE entity = 'session' AND entity_id = OLD.id
    AND NEW.subject_id IN (from_subject, to_subject) AND NEW.visit_id IN (from_visit, to_visit))
BEGIN SELECT RAISE(ABORT, 'a session changes its subject by a reassignment only'); END;
