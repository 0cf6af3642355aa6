// service/arguments.h -- the arguments of a service: --config FILE, and little else.
//
// Threads   Functions without state.
// Errors    bad_argument for anything else, and if there is no file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct ServiceArguments {
    std::optional<std::filesystem::path> config;  // set unless help or version is asked for
    bool check = false;
    bool help = false;
    bool version = false;
    std::string_view flag;  // the one of the service's own that was given; empty: none was
};
// `own_flags` are what this service takes beside, as "--no-loops"; at most one of them is given.
[[nodiscard]] Result<ServiceArguments> parse_service_arguments(
    int argc, char** argv, const std::vector<std::string_view>& own_flags = {});

// Returns "checked as the user NAME", for --check-config. Root is told how to check as the service,
// because it may read everything and so learns nothing of what the service may read.
[[nodiscard]] std::string checked_as(std::string_view program, std::string_view service_user);

}  // namespace stormcellar
