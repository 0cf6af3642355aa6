// base/service_arguments.h -- the arguments of a service: --config FILE, and little else.
//
// Threads   Functions without state.
// Errors    bad_argument for anything else, and if there is no file.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct ServiceArguments {
    std::optional<std::filesystem::path> config;  // set unless help or version is asked for
    bool check = false;
    bool help = false;
    bool version = false;
    std::set<std::string_view> flags;  // those of the service's own that were given
};
// `own_flags` are what this service takes beside, as "--no-loops".
[[nodiscard]] Result<ServiceArguments> parse_service_arguments(
    int argc, char** argv, std::initializer_list<std::string_view> own_flags = {});

// Returns "checked as the user NAME", for --check-config. Root is told how to check as the service,
// because it may read everything and so learns nothing of what the service may read.
[[nodiscard]] std::string checked_as(std::string_view program, std::string_view service_user);

}  // namespace stormcellar
