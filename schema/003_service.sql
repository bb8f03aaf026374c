-- What the service keeps besides jobs, records and ledger: the ticket of each job, events, the audit log, and the answers
-- that it has given. And one more kind of ledger row.

-- The ledger's kinds are fixed by a CHECK, so that its table is made anew for `reprint`: row by row the same, hashes
-- included.
CREATE TABLE ledger_of_003 (
    sequence INTEGER PRIMARY KEY,
    job      INTEGER NOT NULL REFERENCES jobs (id),
    kind     TEXT    NOT NULL CHECK (kind IN ('run_started', 'intent', 'printed', 'unused', 'in_doubt', 'skipped', 'released',
                                              'reprint', 'run_ended')),
    run      INTEGER NOT NULL REFERENCES ledger_of_003 (sequence), -- the run_started row; that row names itself
    first    INTEGER NOT NULL CHECK (first BETWEEN 0 AND 4294967295),
    records  INTEGER NOT NULL CHECK (records BETWEEN 0 AND 4294967296 - first),
    evidence TEXT    NOT NULL,
    time_ns  INTEGER NOT NULL,
    hash     BLOB    NOT NULL CHECK (length(hash) = 32)
) STRICT;
INSERT INTO ledger_of_003 SELECT sequence, job, kind, run, first, records, evidence, time_ns, hash FROM ledger ORDER BY sequence;
DROP TABLE ledger; -- with its indexes and triggers
ALTER TABLE ledger_of_003 RENAME TO ledger;

CREATE INDEX ledger_by_job ON ledger (job);
CREATE INDEX ledger_run_starts ON ledger (job) WHERE kind = 'run_started';
CREATE INDEX ledger_run_ends ON ledger (run) WHERE kind = 'run_ended';
CREATE INDEX ledger_doubts ON ledger (run) WHERE kind = 'in_doubt'; -- few: a doubt is judged without reading its run

CREATE TRIGGER ledger_rows_follow_each_other BEFORE INSERT ON ledger
    WHEN NEW.sequence <> (SELECT ifnull(max(sequence), 0) + 1 FROM ledger)
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;
CREATE TRIGGER ledger_rows_stay BEFORE DELETE ON ledger
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;
CREATE TRIGGER ledger_rows_do_not_change BEFORE UPDATE ON ledger
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;

-- What the service knows of a job besides its records. A job without ticket is one that the command line has printed.
CREATE TABLE tickets (
    job        INTEGER PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
    name       TEXT    NOT NULL,
    printer    TEXT    NOT NULL,           -- name in the settings; empty = none yet
    layout     TEXT    NOT NULL,           -- name in the settings; empty = given with the import
    created_by TEXT    NOT NULL,
    autostart  INTEGER NOT NULL CHECK (autostart IN (0, 1)),
    begun      INTEGER NOT NULL CHECK (begun IN (0, 1)), -- a start was tried, and it is not over: never started by itself
    cancelled  INTEGER NOT NULL CHECK (cancelled IN (0, 1)),
    place      INTEGER,                    -- orders the queue of its printer; NULL = in no queue
    message    TEXT    NOT NULL            -- why it stands
) STRICT;
CREATE INDEX tickets_in_queues ON tickets (printer, place) WHERE place IS NOT NULL;
CREATE INDEX tickets_begun ON tickets (printer) WHERE begun = 1;

-- Stopped by an operator: nothing starts there by itself until somebody starts a job.
CREATE TABLE held_printers (
    printer TEXT PRIMARY KEY -- name in the settings
) STRICT, WITHOUT ROWID;

CREATE TABLE events (
    id      INTEGER PRIMARY KEY AUTOINCREMENT, -- never used again: clients go on behind the last one they have seen
    time_ns INTEGER NOT NULL,
    kind    TEXT    NOT NULL,
    printer TEXT    NOT NULL,
    job     INTEGER, -- of a job that may be gone
    record  INTEGER,
    message TEXT    NOT NULL
) STRICT;

-- Who has changed what, and who was refused.
CREATE TABLE audit (
    id      INTEGER PRIMARY KEY AUTOINCREMENT,
    time_ns INTEGER NOT NULL,
    who     TEXT    NOT NULL,
    what    TEXT    NOT NULL,
    object  TEXT    NOT NULL,
    detail  TEXT    NOT NULL,
    done    INTEGER NOT NULL CHECK (done IN (0, 1))
) STRICT;
CREATE TRIGGER audit_rows_stay BEFORE DELETE ON audit
    BEGIN SELECT RAISE(ABORT, 'the audit log is append-only'); END;
CREATE TRIGGER audit_rows_do_not_change BEFORE UPDATE ON audit
    BEGIN SELECT RAISE(ABORT, 'the audit log is append-only'); END;

-- The answers to requests that carry a key, so that one that comes twice is carried out once.
CREATE TABLE answers (
    caller       TEXT    NOT NULL,
    key          TEXT    NOT NULL,
    time_ns      INTEGER NOT NULL,
    request_hash TEXT    NOT NULL,
    status       INTEGER NOT NULL,
    body         TEXT    NOT NULL,
    PRIMARY KEY (caller, key)
) STRICT, WITHOUT ROWID;
CREATE INDEX answers_by_time ON answers (time_ns);
