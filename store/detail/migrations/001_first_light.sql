-- First light: study, people, photographs, results and the audit trail.
CREATE TABLE this_copy (only_row INTEGER PRIMARY KEY CHECK (only_row = 1), origin TEXT NOT NULL) STRICT;
CREATE TABLE study (id TEXT PRIMARY KEY NOT NULL, protocol TEXT NOT NULL, title TEXT NOT NULL, sponsor TEXT NOT NULL,
  coordinating_centre TEXT NOT NULL) STRICT;
CREATE TABLE site (id TEXT PRIMARY KEY NOT NULL, code TEXT NOT NULL UNIQUE, name TEXT NOT NULL,
  time_zone TEXT NOT NULL) STRICT;
CREATE TABLE subject (id TEXT PRIMARY KEY NOT NULL, pseudonym TEXT NOT NULL UNIQUE,
  site_id TEXT NOT NULL REFERENCES site(id)) STRICT;
CREATE TABLE consent (id TEXT PRIMARY KEY NOT NULL, subject_id TEXT NOT NULL REFERENCES subject(id),
  number INTEGER NOT NULL, kind TEXT NOT NULL CHECK (kind IN ('given', 'withdrawn')), date TEXT NOT NULL,
  UNIQUE (subject_id, number)) STRICT;
CREATE TABLE visit (id TEXT PRIMARY KEY NOT NULL, subject_id TEXT NOT NULL REFERENCES subject(id), name TEXT NOT NULL,
  UNIQUE (subject_id, name)) STRICT;
CREATE VIEW subject_now AS SELECT s.id, s.pseudonym, s.site_id,
  (SELECT date FROM consent WHERE subject_id = s.id AND kind = 'given' ORDER BY number DESC LIMIT 1) AS given,
  (SELECT CASE kind WHEN 'withdrawn' THEN date END FROM consent WHERE subject_id = s.id
    ORDER BY number DESC LIMIT 1) AS withdrawn FROM subject s;

CREATE TABLE object (id TEXT PRIMARY KEY NOT NULL CHECK (length(id) = 64), size_bytes INTEGER NOT NULL,
  kept_at TEXT NOT NULL) STRICT;
CREATE TABLE device (id TEXT PRIMARY KEY NOT NULL, serial TEXT NOT NULL,
  range TEXT NOT NULL CHECK (range IN ('small', 'large')), model TEXT NOT NULL, lens TEXT NOT NULL,
  UNIQUE (serial, range)) STRICT;
CREATE TABLE calibration (id TEXT PRIMARY KEY NOT NULL, device_id TEXT NOT NULL REFERENCES device(id),
  number INTEGER NOT NULL, sha256 TEXT NOT NULL REFERENCES object(id), valid_from TEXT NOT NULL,
  UNIQUE (device_id, number)) STRICT;
CREATE TABLE session (id TEXT PRIMARY KEY NOT NULL, subject_id TEXT NOT NULL REFERENCES subject(id),
  visit_id TEXT NOT NULL REFERENCES visit(id), operator TEXT NOT NULL, opened_at TEXT NOT NULL, closed_at TEXT,
  site_time_zone TEXT NOT NULL, camera_clock_offset_s INTEGER) STRICT;
CREATE INDEX session_subject ON session (subject_id);
CREATE TABLE capture (id TEXT PRIMARY KEY NOT NULL, session_id TEXT NOT NULL REFERENCES session(id),
  number INTEGER NOT NULL, sha256 TEXT NOT NULL REFERENCES object(id), file_name TEXT NOT NULL,
  media_type TEXT NOT NULL, size_bytes INTEGER NOT NULL, role TEXT NOT NULL, body_site TEXT NOT NULL,
  laterality TEXT NOT NULL, imported_at TEXT NOT NULL, metadata TEXT NOT NULL, preflight TEXT NOT NULL,
  UNIQUE (session_id, number), UNIQUE (session_id, sha256)) STRICT;
CREATE INDEX capture_sha256 ON capture (sha256);

CREATE TABLE outline (id TEXT PRIMARY KEY NOT NULL, capture_id TEXT NOT NULL REFERENCES capture(id),
  number INTEGER NOT NULL, sha256 TEXT NOT NULL REFERENCES object(id), drawn_by TEXT NOT NULL, added_at TEXT NOT NULL,
  UNIQUE (capture_id, number)) STRICT;
CREATE TABLE derived (id TEXT PRIMARY KEY NOT NULL, capture_id TEXT NOT NULL REFERENCES capture(id),
  number INTEGER NOT NULL, kind TEXT NOT NULL, media_type TEXT NOT NULL, sha256 TEXT NOT NULL,
  object TEXT NOT NULL REFERENCES object(id), size_bytes INTEGER NOT NULL, provenance TEXT NOT NULL,
  made_at TEXT NOT NULL, UNIQUE (capture_id, number)) STRICT;
CREATE INDEX derived_sha256 ON derived (sha256);
CREATE TABLE outcome (id TEXT PRIMARY KEY NOT NULL, capture_id TEXT NOT NULL REFERENCES capture(id),
  number INTEGER NOT NULL, analysis TEXT NOT NULL, version TEXT NOT NULL, report TEXT NOT NULL, failure_code TEXT,
  failure_message TEXT, failure_context TEXT, supersedes TEXT UNIQUE REFERENCES outcome(id), at TEXT NOT NULL,
  UNIQUE (capture_id, number)) STRICT;
CREATE TABLE measurement (id TEXT PRIMARY KEY NOT NULL, outcome_id TEXT NOT NULL REFERENCES outcome(id),
  number INTEGER NOT NULL, name TEXT NOT NULL, value REAL NOT NULL, unit TEXT NOT NULL, uncertainty REAL NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('ok', 'flagged')), content TEXT NOT NULL, UNIQUE (outcome_id, number)) STRICT;
CREATE VIEW outcome_now AS SELECT * FROM outcome o
  WHERE NOT EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id);

-- The insert trigger keeps the numbering whole: no gap, no second row of a number, no row in between.
CREATE TABLE audit (origin TEXT NOT NULL, sequence INTEGER NOT NULL, utc TEXT NOT NULL,
  utc_offset_min INTEGER NOT NULL, zone TEXT NOT NULL, user TEXT NOT NULL CHECK (user <> ''), machine TEXT NOT NULL,
  software TEXT NOT NULL, action TEXT NOT NULL, entity TEXT NOT NULL, entity_id TEXT NOT NULL, field TEXT NOT NULL,
  old_value TEXT, new_value TEXT, reason TEXT NOT NULL, previous_hash TEXT NOT NULL, hash TEXT NOT NULL,
  PRIMARY KEY (origin, sequence)) STRICT;
CREATE INDEX audit_entity ON audit (entity_id);
CREATE TRIGGER audit_no_delete BEFORE DELETE ON audit BEGIN
  SELECT RAISE(ABORT, 'the audit trail is never deleted'); END;
CREATE TRIGGER audit_no_update BEFORE UPDATE ON audit BEGIN
  SELECT RAISE(ABORT, 'the audit trail is never changed'); END;
CREATE TRIGGER audit_in_order BEFORE INSERT ON audit
  WHEN NEW.sequence <> 1 + (SELECT coalesce(max(sequence), 0) FROM audit WHERE origin = NEW.origin) BEGIN
  SELECT RAISE(ABORT, 'the audit trail grows at its end only'); END;

--guard study
--guard site
--guard subject
--guard consent
--guard visit
--guard object
--guard device
--guard calibration
--guard outline
--guard derived
--guard outcome
--guard measurement
--guard session id, subject_id, visit_id, operator, opened_at, site_time_zone
--guard capture id, session_id, number, sha256, file_name, media_type, size_bytes, imported_at, metadata, preflight
