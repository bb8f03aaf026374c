-- Jobs, their records, and the print ledger (src/spool). Times are ns since the Unix epoch, numbers are mail record numbers.
PRAGMA application_id = 0x6C6E6664; -- "lnfd": tells a spool from the database of another program

CREATE TABLE jobs (
    id                 INTEGER PRIMARY KEY AUTOINCREMENT, -- never used again, even if the job is removed
    source_path        TEXT    NOT NULL,
    source_size        INTEGER NOT NULL,
    source_modified_ns INTEGER NOT NULL,
    source_inode       INTEGER NOT NULL, -- the 64 bits of the unsigned number
    source_companion   TEXT    NOT NULL,
    layout             TEXT    NOT NULL, -- canonical JSON of every option that changes the records
    base               INTEGER NOT NULL CHECK (base BETWEEN 0 AND 4294967295),
    state              TEXT    NOT NULL CHECK (state IN ('importing', 'ready')),
    records            INTEGER NOT NULL DEFAULT 0 CHECK (records BETWEEN 0 AND 4294967295 - base),
    frame_bytes        INTEGER NOT NULL DEFAULT 0,
    content_sha256     TEXT    NOT NULL DEFAULT '',
    created_ns         INTEGER NOT NULL,
    import_report      TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX jobs_by_source ON jobs (source_path);
CREATE INDEX jobs_by_content ON jobs (content_sha256);

-- Some hundred records each, as ready frames.
CREATE TABLE pages (
    id      INTEGER PRIMARY KEY,
    job     INTEGER NOT NULL REFERENCES jobs (id),
    first   INTEGER NOT NULL,
    records INTEGER NOT NULL CHECK (records > 0),
    ends    BLOB    NOT NULL, -- offset behind each frame, 32-bit little-endian
    frames  BLOB    NOT NULL,
    crc     INTEGER NOT NULL, -- CRC-32 over job, first, ends and frames: verified at every read
    UNIQUE (job, first)
) STRICT;

-- The print ledger: only ever appended to. `hash` is SHA-256 over the previous row's hash and every column (ledger.cpp).
CREATE TABLE ledger (
    sequence INTEGER PRIMARY KEY,
    job      INTEGER NOT NULL REFERENCES jobs (id),
    kind     TEXT    NOT NULL CHECK (kind IN ('run_started', 'intent', 'printed', 'unused', 'in_doubt', 'skipped', 'released',
                                              'run_ended')),
    run      INTEGER NOT NULL REFERENCES ledger (sequence), -- the run_started row; that row names itself
    first    INTEGER NOT NULL CHECK (first BETWEEN 0 AND 4294967295),
    records  INTEGER NOT NULL CHECK (records BETWEEN 0 AND 4294967296 - first),
    evidence TEXT    NOT NULL,
    time_ns  INTEGER NOT NULL,
    hash     BLOB    NOT NULL CHECK (length(hash) = 32)
) STRICT;
CREATE INDEX ledger_by_job ON ledger (job);
CREATE INDEX ledger_run_starts ON ledger (job) WHERE kind = 'run_started';
CREATE INDEX ledger_run_ends ON ledger (run) WHERE kind = 'run_ended';

CREATE TRIGGER ledger_rows_follow_each_other BEFORE INSERT ON ledger
    WHEN NEW.sequence <> (SELECT ifnull(max(sequence), 0) + 1 FROM ledger)
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;
CREATE TRIGGER ledger_rows_stay BEFORE DELETE ON ledger
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;
CREATE TRIGGER ledger_rows_do_not_change BEFORE UPDATE ON ledger
    BEGIN SELECT RAISE(ABORT, 'the print ledger is append-only'); END;

-- What the ledger of a job comes to, updated with it in one transaction, so that nobody reads the whole ledger to know.
CREATE TABLE ledger_segments (
    job     INTEGER NOT NULL REFERENCES jobs (id),
    first   INTEGER NOT NULL,
    records INTEGER NOT NULL CHECK (records > 0),
    state   TEXT    NOT NULL CHECK (state IN ('open', 'printed', 'unused', 'in_doubt', 'skipped', 'released')),
    run     INTEGER NOT NULL,
    PRIMARY KEY (job, first)
) STRICT, WITHOUT ROWID;
