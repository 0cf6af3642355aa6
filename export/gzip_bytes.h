// export/gzip_bytes.h -- compresses bytes as gzip; internal.
//
// Threads   Pure function.
// Errors    exhausted if there is no memory.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

// `level` is 1 (fast) to 12 (small), as libdeflate counts.
[[nodiscard]] Result<std::string> gzip_bytes(std::string_view bytes, int level);

}  // namespace stormcellar
