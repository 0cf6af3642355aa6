// base/load_module.h -- modules: what few commands need and would slow down the start of all.
//
// A module is loaded the first time it is asked for, and stays. Thread contract: any thread.
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar {

// The address of `entry` in the module FILE. It is looked for where this program was installed,
// wherever that was moved; in the tree that the program was built in, in the folder of the module's
// room; and where it was to be installed. Not along a path of the loader: that would be searched
// for every library of the program. Errors: unsupported, with the reason.
[[nodiscard]] Result<void*> load_module(const std::string& file, const char* entry,
                                        const std::string& room);

}  // namespace stormcellar
