// service/program.h -- code that the programs of the services share: answers to --help, --version
// and wrong arguments, and errors on stderr.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "service/arguments.h"

namespace stormcellar {

struct ServiceProgram {
    std::string_view name;
    std::string_view usage;
    std::vector<std::string_view> own_flags;  // see parse_service_arguments()
    // Runs the service, or checks its configuration. Returns the exit status.
    std::function<int(const ServiceArguments&)> run;
};

// Runs the whole program and returns its exit status. Wrong arguments give 2, with the usage on
// stderr; an exception gives 1, with its text.
[[nodiscard]] int run_service(const ServiceProgram& program, int argc, char** argv);

// Writes an error to stderr in the program's name. Returns the exit status of a failure, 1.
int complain(std::string_view program, const Error& error);

// Writes that --check-config found no fault in a file, and as which user. Returns the exit status,
// 0.
int say_checked(std::string_view program, std::string_view service_user,
                const std::filesystem::path& file);

// Raises the soft limit of descriptors to `wanted`, as far as the hard limit allows. The usual
// limit of 1,024 exists for old programs. If raising fails, the error appears later where a
// descriptor is missing.
void raise_descriptor_limit(std::uint64_t wanted);

}  // namespace stormcellar
