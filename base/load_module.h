// base/load_module.h -- loads modules: libraries that few commands need. If the programs were
// linked with them, every command would start more slowly.
//
// A module is loaded when it is first used, and stays loaded.
//
// Threads   Any thread may call.
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar {

// Loads the module `file`, and returns the address of `entry` in it. Tries these places: the
// installation of this program, even if it was moved; the module's room in the program's build
// tree; and the configured installation directory. Does not use the loader's search path, because
// changing it would affect every library of the program. Errors: unsupported, with the reason.
[[nodiscard]] Result<void*> load_module(const std::string& file, const char* entry,
                                        const std::string& room);

}  // namespace stormcellar
