-- Treatments, notes, queries and exclusions: added only; a correction supersedes.
CREATE TABLE treatment (id TEXT PRIMARY KEY NOT NULL, subject_id TEXT NOT NULL REFERENCES subject(id),
  date TEXT NOT NULL, text TEXT NOT NULL, in_error INTEGER NOT NULL CHECK (in_error IN (0, 1)), by TEXT NOT NULL,
  at TEXT NOT NULL, supersedes TEXT UNIQUE REFERENCES treatment(id)) STRICT;
CREATE INDEX treatment_subject ON treatment (subject_id);
CREATE TABLE note (id TEXT PRIMARY KEY NOT NULL, entity TEXT NOT NULL, entity_id TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('note', 'deviation')), date TEXT NOT NULL, text TEXT NOT NULL,
  in_error INTEGER NOT NULL CHECK (in_error IN (0, 1)), by TEXT NOT NULL, at TEXT NOT NULL,
  supersedes TEXT UNIQUE REFERENCES note(id)) STRICT;
CREATE INDEX note_entity ON note (entity_id);
CREATE TABLE data_query (id TEXT PRIMARY KEY NOT NULL, entity TEXT NOT NULL, entity_id TEXT NOT NULL,
  text TEXT NOT NULL, by TEXT NOT NULL, at TEXT NOT NULL) STRICT;
CREATE INDEX data_query_entity ON data_query (entity_id);
CREATE TABLE query_step (id TEXT PRIMARY KEY NOT NULL, query_id TEXT NOT NULL REFERENCES data_query(id),
  number INTEGER NOT NULL, state TEXT NOT NULL CHECK (state IN ('open', 'answered', 'closed')), text TEXT NOT NULL,
  by TEXT NOT NULL, at TEXT NOT NULL) STRICT;
CREATE INDEX query_step_query ON query_step (query_id, number);
CREATE VIEW data_query_now AS SELECT q.*, coalesce((SELECT state FROM query_step WHERE query_id = q.id
  ORDER BY number DESC, id DESC LIMIT 1), 'open') AS state FROM data_query q;
CREATE TABLE exclusion (id TEXT PRIMARY KEY NOT NULL, capture_id TEXT NOT NULL REFERENCES capture(id),
  analysis TEXT, name TEXT, number INTEGER NOT NULL, excluded INTEGER NOT NULL CHECK (excluded IN (0, 1)),
  reason TEXT NOT NULL CHECK (reason <> ''), by TEXT NOT NULL, at TEXT NOT NULL) STRICT;
CREATE INDEX exclusion_capture ON exclusion (capture_id, number);
CREATE VIEW exclusion_now AS SELECT * FROM exclusion x WHERE excluded = 1 AND NOT EXISTS (
  SELECT 1 FROM exclusion newer WHERE newer.capture_id = x.capture_id AND newer.analysis IS x.analysis
    AND newer.name IS x.name AND newer.number > x.number);
--guard treatment
--guard note
--guard data_query
--guard query_step
--guard exclusion
