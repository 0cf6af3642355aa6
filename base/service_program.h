// base/service_program.h -- what the programs of the services have in common: answers to --help,
// --version and wrong arguments, errors on stderr, and the words of a reload.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/service_arguments.h"

namespace stormcellar {

struct ServiceProgram {
    std::string_view name;
    std::string_view usage;
    std::vector<std::string_view> own_flags;  // see parse_service_arguments()
    // Runs the service, or checks its configuration. Returns the exit status.
    std::function<int(const ServiceArguments&)> run;
};

// Returns the exit status of a program that does nothing else. Wrong arguments give 2, with the
// usage on stderr; an exception gives 1, with its text.
[[nodiscard]] int run_service(const ServiceProgram& program, int argc, char** argv);

// Writes an error to stderr as that of the program. Returns the exit status of a failure, 1.
int complain(std::string_view program, const Error& error);

// Returns "RELOADING=1" with the monotonic time that systemd requires (sd_notify(3)).
[[nodiscard]] std::string reloading_state();

}  // namespace stormcellar
