#include "base/system_error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace stormcellar {

ErrorCode error_code_of(int error_number) {
    using enum ErrorCode;
    struct Meaning {
        int number;
        ErrorCode code;
    };
    constexpr std::array<Meaning, 11> meanings = {{{ENOENT, not_found},
                                                   {ENOTDIR, not_found},
                                                   {EACCES, permission},
                                                   {EPERM, permission},
                                                   {EROFS, permission},
                                                   {ENOSPC, no_space},
                                                   {EDQUOT, no_space},
                                                   {EMFILE, exhausted},
                                                   {ENFILE, exhausted},
                                                   {ENOMEM, exhausted},
                                                   {EADDRINUSE, busy}}};
    const auto found = std::ranges::find(meanings, error_number, &Meaning::number);
    return found == meanings.end() ? io : found->code;
}

tl::unexpected<Error> system_failure(std::string_view what, int error_number) {
    return fail(error_code_of(error_number), "{}: {}", what,
                std::system_category().message(error_number));
}

}  // namespace stormcellar
