-- Users with roles. What proves a passphrase is kept beside the trail, which holds its SHA-256 only.
CREATE TABLE user (id TEXT PRIMARY KEY NOT NULL, name TEXT NOT NULL UNIQUE COLLATE NOCASE, full_name TEXT NOT NULL,
  role TEXT NOT NULL CHECK (role IN ('coordinator', 'clinician', 'investigator', 'monitor', 'administrator')),
  active INTEGER NOT NULL CHECK (active IN (0, 1))) STRICT;
CREATE TABLE credential (id TEXT PRIMARY KEY NOT NULL, user_id TEXT NOT NULL REFERENCES user(id),
  number INTEGER NOT NULL, verifier_sha256 TEXT NOT NULL) STRICT;
CREATE INDEX credential_user ON credential (user_id);
CREATE TABLE verifier (credential_id TEXT PRIMARY KEY NOT NULL REFERENCES credential(id), text TEXT NOT NULL) STRICT;
CREATE TRIGGER verifier_no_delete BEFORE DELETE ON verifier BEGIN
  SELECT RAISE(ABORT, 'verifier rows are never deleted'); END;
CREATE TRIGGER verifier_no_update BEFORE UPDATE ON verifier BEGIN
  SELECT RAISE(ABORT, 'verifier rows are never changed here'); END;
--guard user id, name
--guard credential
