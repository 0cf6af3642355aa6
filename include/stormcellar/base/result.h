// stormcellar/base/result.h -- results and errors of functions.
//
// Library code never logs and never throws for bad input: it returns a Result. The message of an
// Error is one line that names the file or the value, and the reason, so that it can be shown to a
// user.
//
// Threads   Results and errors are plain values; all functions are pure.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace stormcellar {

// The kind of a failure, for a caller that reacts to it. Empty, truncated, corrupt and unsupported
// input mean different things to a user, so each has its own code.
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
    exhausted,     // the system has no more memory or descriptors
    busy,          // another process holds what is needed: a lock, a database, an address
    no_space,      // the file system is full
    over_budget,   // an allowance of disk or memory is used up, though the system may have more
    unmet,         // no allowed choice meets the requested error or time
    permission,    // the file may not be read or written
    internal,      // a defect of this software
};

// The party that must change something before another try can succeed.
enum class Cause {
    data,           // the writer of the input: another try reads the same bytes
    system,         // the machine or another process: another try may succeed
    configuration,  // the caller or the configuration: a request is not allowed or not possible
};

// Returns the usual cause of a code. Error::cause() returns the cause of one error.
[[nodiscard]] constexpr Cause cause_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::empty:
        case ErrorCode::truncated:
        case ErrorCode::corrupt:
        case ErrorCode::unsupported:
        case ErrorCode::not_level2:
        case ErrorCode::not_a_file:
            return Cause::data;
        case ErrorCode::not_found:
        case ErrorCode::io:
        case ErrorCode::exhausted:
        case ErrorCode::busy:
        case ErrorCode::no_space:
        case ErrorCode::internal:
            return Cause::system;
        case ErrorCode::bad_argument:
        case ErrorCode::over_budget:
        case ErrorCode::unmet:
        case ErrorCode::permission:
            return Cause::configuration;
    }
    return Cause::system;
}

// Returns true if the system is short of disk space, memory or descriptors. If reading a file fails
// for such a reason, the file is not to blame, however often it fails.
[[nodiscard]] constexpr bool is_shortage(ErrorCode code) {
    return code == ErrorCode::no_space || code == ErrorCode::exhausted;
}

struct Error {
    ErrorCode code = ErrorCode::internal;
    std::string message;
    // Set by a function that knows a better cause than cause_of() returns.
    std::optional<Cause> known_cause = std::nullopt;

    [[nodiscard]] Cause cause() const { return known_cause.value_or(cause_of(code)); }
};

// Returns the error with this cause instead of the usual one.
[[nodiscard]] inline Error caused_by(Cause cause, Error error) {
    error.known_cause = cause;
    return error;
}

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
