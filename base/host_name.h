// base/host_name.h -- what this machine is called.
//
// Threads   Any thread.
#pragma once

#include <string>

namespace stormcellar {

// Returns the host's name without its domain, as far as it is letters and digits (at most 32), so
// that it can be part of a file's name. A host without a name is "host".
[[nodiscard]] std::string host_name();

}  // namespace stormcellar
