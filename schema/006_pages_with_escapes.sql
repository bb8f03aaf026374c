-- The pages that hold a `\`, which is there only to escape: whether a job has one is asked before each start
-- (Spool::has_escapes, in these words). Made by reading every page once.
CREATE INDEX pages_with_escapes ON pages (job) WHERE instr(frames, x'5C') > 0;
