// base/load_module.h -- loads modules: libraries that few commands need and that would slow down
// the start of all.
//
// A module is loaded when it is first used, and stays loaded.
//
// Threads   Any thread may call.
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar {

// Returns the address of `entry` in the module FILE. It looks for the module where this program was
// installed, even if it was moved since; in the build tree of the program, in the folder of the
// module's room; and in the configured installation directory. It uses no search path of the
// loader, because that would apply to every library of the program. Errors: unsupported, with the
// reason.
[[nodiscard]] Result<void*> load_module(const std::string& file, const char* entry,
                                        const std::string& room);

}  // namespace stormcellar
