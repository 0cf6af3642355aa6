// base/host_name.h -- the name of this machine.
//
// Threads   Any thread.
#pragma once

#include <string>

namespace stormcellar {

// Returns the letters and digits (at most 32) of the host's name without its domain, so that it can
// be part of a file's name. A host without a name is "host".
[[nodiscard]] std::string host_name();

}  // namespace stormcellar
