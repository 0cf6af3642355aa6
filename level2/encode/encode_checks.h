// level2/encode/encode_checks.h -- checks that a volume can be written; internal to the writer.
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

// Checks that the arrays have their stated sizes, that the decoder can tell the sweeps apart, and
// that the volume has the station and the volume block if message 31 needs them. ReadBack checks
// that no number changes in a message.
[[nodiscard]] Status check_encodable(const Volume& volume);

}  // namespace stormcellar::level2
