// render/image/unknown_name.h -- makes the error for a name that a table does not have.
//
// Threads   Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/nearest_name.h"
#include "stormcellar/base/result.h"

namespace stormcellar::render {

// Returns an error such as "there is no theme 'drak'; did you mean 'dark'?" for the kind "theme".
// If no name is near, lists all names instead, as in "there is no theme 'x'; the known themes are
// dark or light". In this example, `all` is "themes are dark or light".
[[nodiscard]] inline tl::unexpected<Error> unknown_name(std::string_view kind,
                                                        std::string_view name,
                                                        std::span<const std::string> names,
                                                        std::string_view all,
                                                        ErrorCode code = ErrorCode::bad_argument) {
    const std::string meant = did_you_mean(name, names);
    if (!meant.empty()) return fail(code, "there is no {} '{}'{}", kind, name, meant);
    return fail(code, "there is no {} '{}'; the known {}", kind, name, all);
}

}  // namespace stormcellar::render
