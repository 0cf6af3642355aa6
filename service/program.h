// service/program.h -- code that the programs of all services share. It answers --help, --version
// and wrong arguments, and writes errors to stderr.
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

// Runs the whole program and returns its exit status. Wrong arguments give the status 2 and write
// the usage to stderr. An exception gives the status 1 and writes its text.
[[nodiscard]] int run_service(const ServiceProgram& program, int argc, char** argv);

// Writes "PROGRAM: ERROR" to stderr. Returns 1, the exit status for a failure.
int complain(std::string_view program, const Error& error);

// Reports that --check-config found no fault in a file, and as which user the file was checked.
// Returns the exit status 0.
int say_checked(std::string_view program, std::string_view service_user,
                const std::filesystem::path& file);

// Raises the soft limit of descriptors to `wanted`, as far as the hard limit allows. The usual
// limit of 1,024 exists only for old programs. Ignores failures: if a descriptor is missing later,
// there is an error then.
void raise_descriptor_limit(std::uint64_t wanted);

}  // namespace stormcellar
