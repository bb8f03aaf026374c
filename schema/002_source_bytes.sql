-- What a dropped file consisted of, so that the same batch is not imported twice, whatever it is called then.
ALTER TABLE jobs ADD COLUMN source_sha256 TEXT NOT NULL DEFAULT ''; -- SHA-256 of the file's bytes, hex; empty = not known
CREATE INDEX jobs_by_source_bytes ON jobs (source_sha256) WHERE source_sha256 <> '';
