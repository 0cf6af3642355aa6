// base/result.h -- how a function says that it failed.
//
// Library code never logs and never throws for bad input: it returns a Result. The message of an
// Error is one line that names the file or the value and the reason, fit to be shown to a user.
#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace stormcellar {

// What kind of failure, for a caller that acts on it. Empty, truncated, corrupt and unsupported
// input are different things to a user, so they are different codes.
enum class ErrorCode {
    bad_argument,  // the caller asked for something that makes no sense
    not_found,     // the thing named does not exist
    empty,         // the input holds no bytes
    truncated,     // the input ends before anything whole
    corrupt,       // the input contradicts itself or its checksum
    unsupported,   // valid, but of a kind that this software does not handle
    not_level2,    // the input is not a Level II file
    not_a_file,    // a directory, FIFO or other thing that is not a regular file
    io,            // the operating system refused a read or a write
    no_space,      // the file system is full
    over_budget,   // what may be kept is used up, though the file system may have room
    permission,    // the file may not be read or written
    internal,      // a defect of this software
};

struct Error {
    ErrorCode code = ErrorCode::internal;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

// Builds an Error with a formatted message: return fail(ErrorCode::io, "{}: {}", path, reason);
template <class... Args>
[[nodiscard]] tl::unexpected<Error> fail(ErrorCode code, fmt::format_string<Args...> format,
                                         Args&&... args) {
    return tl::unexpected<Error>(Error{code, fmt::format(format, std::forward<Args>(args)...)});
}

// Passes an error on, as in: if (!volume) return pass_on(volume);
template <class T>
[[nodiscard]] tl::unexpected<Error> pass_on(const Result<T>& result) {
    return tl::unexpected<Error>(result.error());
}

}  // namespace stormcellar
