// base/system_error.h -- translates errno into error codes.
//
// Threads: pure functions.
#pragma once

#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

// Returns not_found, permission, no_space, exhausted or busy for the error numbers that mean these,
// and io for all other numbers.
[[nodiscard]] ErrorCode error_code_of(int error_number);

// Returns an error with the code of error_code_of() and the message "WHAT: REASON", with the
// system's reason.
[[nodiscard]] tl::unexpected<Error> system_failure(std::string_view what, int error_number);

}  // namespace stormcellar
