// capi/guarded.h -- the boundary between C and C++: no exception crosses it, and each failure
// becomes a code and a message.
//
// Threads   Functions without state.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "stormcellar.h"
#include "stormcellar/base/result.h"

namespace stormcellar::capi {

[[nodiscard]] stormcellar_code code_of(ErrorCode code);

// Sets the caller's error, if there is one. Cuts a message that is too long.
void tell(stormcellar_error* error, stormcellar_code code, std::string_view message) noexcept;

// Copies the text with a closing 0, cut to the size.
void copy_text(std::string_view text, char* to, std::size_t size) noexcept;

// Calls the function, which returns a Status, and returns its code.
template <class Function>
stormcellar_code guarded(stormcellar_error* error, Function&& function) noexcept {
    try {
        const Status status = std::forward<Function>(function)();
        if (status) {
            tell(error, STORMCELLAR_OK, "");
            return STORMCELLAR_OK;
        }
        const stormcellar_code code = code_of(status.error().code);
        tell(error, code, status.error().message);
        return code;
    } catch (const std::bad_alloc&) {
        tell(error, STORMCELLAR_EXHAUSTED, "there is no more memory");
        return STORMCELLAR_EXHAUSTED;
    } catch (const std::exception& defect) {
        tell(error, STORMCELLAR_INTERNAL, defect.what());
        return STORMCELLAR_INTERNAL;
    } catch (...) {
        tell(error, STORMCELLAR_INTERNAL, "an unknown exception");
        return STORMCELLAR_INTERNAL;
    }
}

// Returns the error bad_argument, with the name of the null pointer.
[[nodiscard]] inline tl::unexpected<Error> is_null(std::string_view name) {
    return fail(ErrorCode::bad_argument, "{} is null", name);
}

// Copies a struct whose first member is its size, as many bytes as the caller knows. Errors:
// bad_argument for a size that is smaller than the size itself.
template <class Facts>
[[nodiscard]] Status give(const Facts& facts, Facts* to) {
    if (to == nullptr) return is_null("facts");
    const std::size_t size = to->size;
    if (size < sizeof(std::size_t))
        return fail(ErrorCode::bad_argument, "facts.size is {}; set it to sizeof *facts", size);
    std::memcpy(to, &facts, std::min(size, sizeof facts));
    to->size = size;
    return {};
}

// Reads a struct whose first member is its size. Members that the caller does not know are zero.
// For null, all members are zero.
template <class Options>
[[nodiscard]] Result<Options> take(const Options* options) {
    Options all{};
    if (options == nullptr) return all;
    if (options->size < sizeof(std::size_t))
        return fail(ErrorCode::bad_argument, "options.size is {}; set it to sizeof *options",
                    options->size);
    std::memcpy(&all, options, std::min(options->size, sizeof all));
    return all;
}

}  // namespace stormcellar::capi
