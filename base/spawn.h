// base/spawn.h -- starts a program with chosen input and output.
//
// The program inherits no other descriptor than these three.
//
// Threads   Pure functions of the process.
// Errors    not_found, permission or io if it could not be started.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct SpawnOptions {
    // Descriptors that become its input, output and errors; negative: /dev/null.
    int in = -1, out = -1, err = -1;
    // With a process group and usual signals of its own, so that Ctrl-C in a terminal ends only
    // this program; else with those of this program.
    bool is_apart = true;
};

// Returns the process, which the caller must wait for.
[[nodiscard]] Result<pid_t> spawn(const std::filesystem::path& program,
                                  const std::vector<std::string>& arguments,
                                  const SpawnOptions& options = {});

// Returns the path of the program of this name: beside this one, else on PATH; empty if there is
// none.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

}  // namespace stormcellar
