// level2/encode_checks.h -- whether messages can hold a volume; internal to the writer.
#pragma once

#include "base/result.h"
#include "level2/volume.h"

namespace stormcellar::level2 {

template <class... Args>
tl::unexpected<Error> refuse(fmt::format_string<Args...> format, Args&&... args) {
    return fail(ErrorCode::bad_argument, "cannot write the volume: {}",
                fmt::format(format, std::forward<Args>(args)...));
}

// Everything that the writer would have to round or leave out is refused.
[[nodiscard]] Status check_encodable(const Volume& volume);

}  // namespace stormcellar::level2
