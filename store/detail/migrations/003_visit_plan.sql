-- Arms, the visit plan, the pattern of pseudonyms, and the day of a session at its site.
ALTER TABLE study ADD COLUMN subject_pattern TEXT;
ALTER TABLE study ADD COLUMN check_digit TEXT;
ALTER TABLE session ADD COLUMN day TEXT;
CREATE TRIGGER session_day_no_update BEFORE UPDATE OF day ON session BEGIN
  SELECT RAISE(ABORT, 'session rows are never changed here'); END;
CREATE TABLE arm (id TEXT PRIMARY KEY NOT NULL, name TEXT NOT NULL UNIQUE, title TEXT NOT NULL) STRICT;
CREATE TABLE arm_assignment (id TEXT PRIMARY KEY NOT NULL, subject_id TEXT NOT NULL REFERENCES subject(id),
  arm_id TEXT NOT NULL REFERENCES arm(id), number INTEGER NOT NULL, date TEXT NOT NULL) STRICT;
CREATE INDEX arm_assignment_subject ON arm_assignment (subject_id);
CREATE TABLE planned_visit (id TEXT PRIMARY KEY NOT NULL, name TEXT NOT NULL, arm_id TEXT REFERENCES arm(id),
  day INTEGER NOT NULL, window_from INTEGER NOT NULL CHECK (window_from <= 0),
  window_to INTEGER NOT NULL CHECK (window_to >= 0), dropped INTEGER NOT NULL CHECK (dropped IN (0, 1)),
  supersedes TEXT UNIQUE REFERENCES planned_visit(id)) STRICT;
CREATE VIEW planned_visit_now AS SELECT * FROM planned_visit p WHERE dropped = 0
  AND NOT EXISTS (SELECT 1 FROM planned_visit newer WHERE newer.supersedes = p.id);
--guard arm
--guard arm_assignment
--guard planned_visit
