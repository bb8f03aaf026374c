-- Which machine stands behind the name of a printer: a job must not start on another one unnoticed.
CREATE TABLE printers (
    printer       TEXT PRIMARY KEY, -- name in the settings
    serial_number TEXT NOT NULL     -- what `?VS` said when it was first heard of, or what an operator has accepted since
) STRICT, WITHOUT ROWID;
