// cache/map_guard.h -- makes a file that is cut under its map an error instead of the end of the
// program.
//
// Reading a page of a map beyond the end of its file, or a page that the disk cannot deliver,
// raises SIGBUS. With the guard, such a fault in the map of a GridFile turns the whole map into
// zeros and is remembered: GridFile::check_whole() returns truncated from then on. So a user of a
// view calls check_whole() afterward and discards the work on an error. Every other SIGBUS keeps
// its effect. Signals belong to the program, so a program installs the guard; no library does.
#pragma once

namespace stormcellar::cache {

// Installs the guard for the rest of the process; further calls do nothing. Any thread may call it,
// preferably before the first grid file is opened. Setting another handler for SIGBUS later removes
// the guard.
void install_map_guard();

}  // namespace stormcellar::cache
