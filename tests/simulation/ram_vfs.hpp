// The C side of the RAM disk: the function tables that SQLite calls.
#pragma once

namespace linefeed::simulation {

/// Registers the VFS ram_disk_vfs; once.
void register_ram_vfs();

} // namespace linefeed::simulation
