// base/system_error.h -- what a number in errno means to a caller.
//
// Threads: pure functions.
#pragma once

#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

// not_found, permission, no_space or exhausted where the number says so, else io.
[[nodiscard]] ErrorCode error_code_of(int error_number);

// An error of that code: "WHAT: the system's own words".
[[nodiscard]] tl::unexpected<Error> system_failure(std::string_view what, int error_number);

}  // namespace stormcellar
