-- What a printer has told of itself, and what a probe of it has found: kept while it is switched off.
CREATE TABLE printer_memory (
    printer       TEXT PRIMARY KEY, -- name in the settings
    serial_number TEXT NOT NULL,    -- the next three as `?VS` says
    type          TEXT NOT NULL,
    firmware      TEXT NOT NULL,
    probe         TEXT NOT NULL,    -- what it found, JSON; empty = not probed since it is this machine with this firmware
    probed_ns     INTEGER NOT NULL  -- wall time; 0 = not probed
) STRICT, WITHOUT ROWID;
