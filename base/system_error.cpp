#include "base/system_error.h"

#include <cerrno>
#include <system_error>

namespace stormcellar {

ErrorCode error_code_of(int error_number) {
    switch (error_number) {
        case ENOENT:
        case ENOTDIR:
            return ErrorCode::not_found;
        case EACCES:
        case EPERM:
        case EROFS:
            return ErrorCode::permission;
        case ENOSPC:
        case EDQUOT:
            return ErrorCode::no_space;
        case EMFILE:
        case ENFILE:
        case ENOMEM:
            return ErrorCode::exhausted;
        default:
            return ErrorCode::io;
    }
}

tl::unexpected<Error> system_failure(std::string_view what, int error_number) {
    return fail(error_code_of(error_number), "{}: {}", what,
                std::system_category().message(error_number));
}

}  // namespace stormcellar
