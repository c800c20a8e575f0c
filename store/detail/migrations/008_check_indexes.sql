-- The check walks the trail entity by entity; locks and visits look for the sessions of a visit.
CREATE INDEX audit_by_entity ON audit (entity, entity_id);
CREATE INDEX session_visit ON session (visit_id);
CREATE INDEX capture_role ON capture (role);
