// base/service_arguments.h -- the arguments of a service: --config FILE, and little else.
//
// Threads   A pure function.
// Errors    bad_argument for anything else, and if there is no file.
#pragma once

#include <filesystem>
#include <optional>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct ServiceArguments {
    std::optional<std::filesystem::path> config;  // set unless help or version is asked for
    bool check = false;
    bool help = false;
    bool version = false;
};
[[nodiscard]] Result<ServiceArguments> parse_service_arguments(int argc, char** argv);

}  // namespace stormcellar
