// service/arguments.h -- the arguments of a service: --config FILE, and little else.
//
// Threads   Functions without state.
// Errors    bad_argument for any other argument, and if there is no file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct ServiceArguments {
    std::optional<std::filesystem::path> config;  // set unless help or version was requested
    bool check = false;
    bool help = false;
    bool version = false;
    std::string_view flag;  // the service's own flag that was given; empty: none
};
// Parses the arguments. `own_flags` are further flags of this service, such as "--no-loops"; at
// most one of them may be given.
[[nodiscard]] Result<ServiceArguments> parse_service_arguments(
    int argc, char** argv, const std::vector<std::string_view>& own_flags = {});

// Returns "checked as the user NAME", for --check-config. For root it adds how to check as the
// service, because root may read everything and so does not learn what the service may read.
[[nodiscard]] std::string checked_as(std::string_view program, std::string_view service_user);

}  // namespace stormcellar
