// service/arguments.h -- parses the command line of a service: --config FILE, and few other flags.
//
// Threads   Functions without state.
// Errors    bad_argument for any other argument, and if --config FILE is missing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct ServiceArguments {
    std::optional<std::filesystem::path> config;  // set unless --help or --version was given
    bool check = false;
    bool help = false;
    bool version = false;
    std::string_view flag;  // the flag of `own_flags` that was given; empty: none
};
// Parses the arguments. `own_flags` are the further flags of this service, such as "--no-loops"; at
// most one of them may be given.
[[nodiscard]] Result<ServiceArguments> parse_service_arguments(
    int argc, char** argv, const std::vector<std::string_view>& own_flags = {});

// Returns the text "checked as the user NAME" for --check-config. If the user is root, the text
// also says how to check as the user of the service, because root may read files that the service
// may not.
[[nodiscard]] std::string checked_as(std::string_view program, std::string_view service_user);

}  // namespace stormcellar
