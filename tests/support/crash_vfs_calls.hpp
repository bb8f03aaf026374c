// Where CrashVfs (crash_vfs.cpp) gets its entry points from.
#pragma once

struct sqlite3_vfs;

namespace linefeed::test {

/// Sets the calls and sizes of `vfs`, whose pAppData is a CrashVfs.
void fill_crash_vfs_calls(sqlite3_vfs& vfs);

} // namespace linefeed::test
