-- A lock on the study also keeps what the whole study shares: its sites and arms, its devices and what is known of them.
CREATE TRIGGER site_locked BEFORE INSERT ON site WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER arm_locked BEFORE INSERT ON arm WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER device_locked BEFORE INSERT ON device WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER calibration_locked BEFORE INSERT ON calibration
WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
CREATE TRIGGER device_check_locked BEFORE INSERT ON device_check
WHEN EXISTS (SELECT 1 FROM lock_now WHERE entity = 'study')
BEGIN SELECT RAISE(ABORT, 'the study is locked: nothing is added; striae lock list names the lock'); END;
