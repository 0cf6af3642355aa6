// cache/map_guard.h -- makes a file that is cut under its map an error instead of the program's
// end.
//
// Reading a page of a map beyond the end of its file, or a page that the disk cannot read, raises
// SIGBUS. With the guard, such a fault in the map of a GridFile turns the whole map into zeros and
// is remembered: GridFile::check_whole() returns truncated from then on. So a user of a view calls
// check_whole() afterwards, and discards the work on an error. Every other SIGBUS is handled as
// before. Signals belong to the program, so a program installs the guard; no library does.
#pragma once

namespace stormcellar::cache {

// Holds for the rest of the process; further calls do nothing. Any thread may call it, best before
// the first grid file is opened. A later handler for SIGBUS replaces the guard.
void install_map_guard();

}  // namespace stormcellar::cache
