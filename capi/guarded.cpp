#include "capi/guarded.h"

#include "stormcellar/base/version.h"

namespace stormcellar::capi {

stormcellar_code code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::bad_argument:
            return STORMCELLAR_BAD_ARGUMENT;
        case ErrorCode::not_found:
            return STORMCELLAR_NOT_FOUND;
        case ErrorCode::empty:
            return STORMCELLAR_EMPTY;
        case ErrorCode::truncated:
            return STORMCELLAR_TRUNCATED;
        case ErrorCode::corrupt:
            return STORMCELLAR_CORRUPT;
        case ErrorCode::unsupported:
            return STORMCELLAR_UNSUPPORTED;
        case ErrorCode::not_level2:
            return STORMCELLAR_NOT_LEVEL2;
        case ErrorCode::not_a_file:
            return STORMCELLAR_NOT_A_FILE;
        case ErrorCode::io:
            return STORMCELLAR_IO;
        case ErrorCode::exhausted:
            return STORMCELLAR_EXHAUSTED;
        case ErrorCode::busy:
            return STORMCELLAR_BUSY;
        case ErrorCode::no_space:
            return STORMCELLAR_NO_SPACE;
        case ErrorCode::over_budget:
            return STORMCELLAR_OVER_BUDGET;
        case ErrorCode::unmet:
            return STORMCELLAR_UNMET;
        case ErrorCode::permission:
            return STORMCELLAR_PERMISSION;
        case ErrorCode::internal:
            break;
    }
    return STORMCELLAR_INTERNAL;
}

void copy_text(std::string_view text, char* to, std::size_t size) noexcept {
    if (size == 0) return;
    std::size_t length = std::min(text.size(), size - 1);
    // Do not cut within a character of UTF-8.
    while (length > 0 && length < text.size() &&
           (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80)
        --length;
    if (length > 0) std::memcpy(to, text.data(), length);
    to[length] = 0;
}

void tell(stormcellar_error* error, stormcellar_code code, std::string_view message) noexcept {
    if (error == nullptr) return;
    error->code = code;
    copy_text(message, error->message, sizeof error->message);
}

}  // namespace stormcellar::capi

const char* stormcellar_version(void) {
    static_assert(stormcellar::software_version.data()[stormcellar::software_version.size()] == 0);
    return stormcellar::software_version.data();
}
