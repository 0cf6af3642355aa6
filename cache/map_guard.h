// cache/map_guard.h -- turns the truncation of a mapped file into an error instead of the end of
// the program.
//
// A program that reads a page of a map beyond the end of the file, or a page that the disk cannot
// deliver, gets the signal SIGBUS. With the guard, such a fault in the map of a GridFile replaces
// the whole map by zeros, and GridFile::check_whole() returns truncated from then on. So a user of
// a view must call check_whole() afterward and discard the work if it fails. Every other SIGBUS has
// its usual effect. The program must install the guard, because a library should not handle
// signals.
#pragma once

namespace stormcellar::cache {

// Installs the guard for the rest of the process; further calls do nothing. Any thread may call
// this function, preferably before the first grid file is opened. Setting another handler for
// SIGBUS later removes the guard.
void install_map_guard();

}  // namespace stormcellar::cache
