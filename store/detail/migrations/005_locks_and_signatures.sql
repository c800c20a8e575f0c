-- A lock is kept by the database itself: while it holds, no program can add to or change what it covers. Consent,
-- notes, queries and signatures stay possible.
CREATE TABLE lock (id TEXT PRIMARY KEY NOT NULL,
  entity TEXT NOT NULL CHECK (entity IN ('study', 'subject', 'visit', 'session')), entity_id TEXT NOT NULL,
  reason TEXT NOT NULL CHECK (reason <> ''), by TEXT NOT NULL, at TEXT NOT NULL) STRICT;
CREATE TABLE unlock (id TEXT PRIMARY KEY NOT NULL, lock_id TEXT NOT NULL UNIQUE REFERENCES lock(id),
  reason TEXT NOT NULL CHECK (reason <> ''), by TEXT NOT NULL, at TEXT NOT NULL) STRICT;
CREATE TABLE signature (id TEXT PRIMARY KEY NOT NULL, entity TEXT NOT NULL, entity_id TEXT NOT NULL,
  meaning TEXT NOT NULL CHECK (meaning IN ('reviewed', 'approved')), user_id TEXT NOT NULL REFERENCES user(id),
  signer TEXT NOT NULL, role TEXT NOT NULL, at TEXT NOT NULL, content_sha256 TEXT NOT NULL) STRICT;
CREATE INDEX signature_entity ON signature (entity_id);
-- An unlock voids the signatures on what was locked, for good.
CREATE TABLE void_signature (id TEXT PRIMARY KEY NOT NULL, signature_id TEXT NOT NULL UNIQUE REFERENCES signature(id),
  unlock_id TEXT NOT NULL REFERENCES unlock(id)) STRICT;
CREATE VIEW lock_now AS SELECT * FROM lock l WHERE NOT EXISTS (SELECT 1 FROM unlock WHERE lock_id = l.id);
CREATE VIEW locked_subject AS SELECT s.id, l.id AS lock_id FROM subject s
  JOIN lock_now l ON l.entity = 'study' OR l.entity_id = s.id;
CREATE VIEW locked_session AS SELECT e.id, l.id AS lock_id FROM session e
  JOIN lock_now l ON l.entity = 'study' OR l.entity_id IN (e.id, e.visit_id, e.subject_id);
CREATE VIEW locked_capture AS SELECT c.id, e.lock_id FROM capture c JOIN locked_session e ON e.id = c.session_id;
CREATE TRIGGER subject_locked BEFORE INSERT ON subject WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER visit_locked BEFORE INSERT ON visit
WHEN EXISTS (SELECT 1 FROM locked_subject WHERE id = NEW.subject_id)
BEGIN SELECT RAISE(ABORT, 'this subject is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER session_locked BEFORE INSERT ON session
WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study' OR entity_id IN (NEW.subject_id, NEW.visit_id))
BEGIN SELECT RAISE(ABORT, 'this subject or visit is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER session_locked_update BEFORE UPDATE ON session
WHEN EXISTS (SELECT 1 FROM locked_session WHERE id = OLD.id)
  OR EXISTS (SELECT 1 FROM lock_now WHERE entity_id IN (NEW.subject_id, NEW.visit_id))
BEGIN SELECT RAISE(ABORT, 'this session is locked: nothing changes; striae lock list names the lock'); END;
CREATE TRIGGER capture_locked BEFORE INSERT ON capture
WHEN EXISTS (SELECT 1 FROM locked_session WHERE id = NEW.session_id)
BEGIN SELECT RAISE(ABORT, 'this session is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER capture_locked_update BEFORE UPDATE ON capture
WHEN EXISTS (SELECT 1 FROM locked_session WHERE id IN (OLD.session_id, NEW.session_id))
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing changes; striae lock list names the lock'); END;
CREATE TRIGGER outline_locked BEFORE INSERT ON outline
WHEN EXISTS (SELECT 1 FROM locked_capture WHERE id = NEW.capture_id)
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER derived_locked BEFORE INSERT ON derived
WHEN EXISTS (SELECT 1 FROM locked_capture WHERE id = NEW.capture_id)
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER outcome_locked BEFORE INSERT ON outcome
WHEN EXISTS (SELECT 1 FROM locked_capture WHERE id = NEW.capture_id)
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER measurement_locked BEFORE INSERT ON measurement
WHEN EXISTS (SELECT 1 FROM outcome o JOIN locked_capture c ON c.id = o.capture_id WHERE o.id = NEW.outcome_id)
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER exclusion_locked BEFORE INSERT ON exclusion
WHEN EXISTS (SELECT 1 FROM locked_capture WHERE id = NEW.capture_id)
BEGIN SELECT RAISE(ABORT, 'this capture is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER treatment_locked BEFORE INSERT ON treatment
WHEN EXISTS (SELECT 1 FROM locked_subject WHERE id = NEW.subject_id)
BEGIN SELECT RAISE(ABORT, 'this subject is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER arm_assignment_locked BEFORE INSERT ON arm_assignment
WHEN EXISTS (SELECT 1 FROM locked_subject WHERE id = NEW.subject_id)
BEGIN SELECT RAISE(ABORT, 'this subject is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER planned_visit_locked BEFORE INSERT ON planned_visit
WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: its plan does not change; striae lock list names the lock'); END;
--guard lock
--guard unlock
--guard signature
--guard void_signature
