// base/load_module.h -- modules: libraries that few commands need and that would slow down the
// start of all.
//
// A module is loaded when it is first used, and stays loaded.
//
// Threads   Any thread may call.
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar {

// Returns the address of `entry` in the module FILE. The module is searched where this program was
// installed, even if it was moved since; in the build tree of the program, in the folder of the
// module's room; and where it was to be installed. It is not searched along a path of the loader,
// because that would be searched for every library of the program. Errors: unsupported, with the
// reason.
[[nodiscard]] Result<void*> load_module(const std::string& file, const char* entry,
                                        const std::string& room);

}  // namespace stormcellar
