-- Which machine stands behind the name of a printer: a job must not start on another one unnoticed.
CREATE TABLE printers (
    printer       TEXT PRIMARY KEY, -- name in the settings
    serial_number TEXT NOT NULL     -- what `?VS` said when it was first heard of, or what an operator has accepted since
) STRICT, WITHOUT ROWID;

-- The first record of each job, so that a batch which begins with the records of another is found without reading all.
CREATE TABLE job_heads (
    job  INTEGER PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
    head TEXT NOT NULL -- SHA-256 of the frame of its first record, hex
) STRICT;
CREATE INDEX job_heads_by_head ON job_heads (head);
