// level2/encode/encode_checks.h -- checks whether a volume can be written at all; internal to the
// writer.
//
// Threads   Pure functions.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

template <class... Args>
tl::unexpected<Error> refuse(fmt::format_string<Args...> format, Args&&... args) {
    return fail(ErrorCode::bad_argument, "cannot write the volume: {}",
                fmt::format(format, std::forward<Args>(args)...));
}

// Checks that the arrays have their stated sizes, that the radials separate the sweeps, and that
// message 31 gets the station and the block that it needs. read_back.h checks whether messages keep
// the numbers.
[[nodiscard]] Status check_encodable(const Volume& volume);

}  // namespace stormcellar::level2
