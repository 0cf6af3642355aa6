// base/host_name.h -- returns the name of this machine.
//
// Threads   Any thread.
#pragma once

#include <string>

namespace stormcellar {

// Returns the letters and digits of the host's name without its domain, at most 32, as a part of
// file names. Returns "host" if there are none.
[[nodiscard]] std::string host_name();

}  // namespace stormcellar
