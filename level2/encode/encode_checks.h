// level2/encode/encode_checks.h -- whether a volume can be written at all; internal to the writer.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

template <class... Args>
tl::unexpected<Error> refuse(fmt::format_string<Args...> format, Args&&... args) {
    return fail(ErrorCode::bad_argument, "cannot write the volume: {}",
                fmt::format(format, std::forward<Args>(args)...));
}

// That its arrays hold what they say, its sweeps are told apart by their radials, and message 31
// gets the station and the block that it must have. What messages do with the numbers is for
// read_back.h.
[[nodiscard]] Status check_encodable(const Volume& volume);

}  // namespace stormcellar::level2
