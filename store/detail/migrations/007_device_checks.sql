-- Checks of a device on plane, ball or ball bar: added only. The time is a span: a day when only the day is known.
CREATE TABLE device_check (id TEXT PRIMARY KEY NOT NULL, device_id TEXT NOT NULL REFERENCES device(id),
  number INTEGER NOT NULL, kind TEXT NOT NULL CHECK (kind IN ('plane', 'ball', 'distance')),
  checked_from TEXT NOT NULL, checked_until TEXT NOT NULL CHECK (checked_until >= checked_from),
  passed INTEGER NOT NULL CHECK (passed IN (0, 1)), evidence TEXT NOT NULL, result TEXT NOT NULL, by TEXT NOT NULL,
  at TEXT NOT NULL, UNIQUE (device_id, number)) STRICT;
--guard device_check
