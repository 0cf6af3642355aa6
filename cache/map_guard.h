// cache/map_guard.h -- a file that is cut under its map is an error, not the end of the program.
//
// Reading a page of a map that lies beyond its file's end, or that the disk cannot give, raises
// SIGBUS. With the guard, such a fault in the map of a GridFile turns that whole map into zeros and
// is remembered: GridFile::check_whole() says truncated from then on. So whoever has used a view
// asks check_whole() and throws the work away on an error. Every other SIGBUS goes where it went
// before. Signals belong to the program, so a program asks for the guard; no library does.
#pragma once

namespace stormcellar::cache {

// For the rest of the process; further calls do nothing. May be called from any thread, best before
// the first grid file is opened. Who sets another handler for SIGBUS later takes the guard away.
void install_map_guard();

}  // namespace stormcellar::cache
