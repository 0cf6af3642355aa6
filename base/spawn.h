// base/spawn.h -- starts a program with chosen input and output.
//
// The program inherits only these three descriptors.
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
    // If true, the program has its own process group and default signals, so that Ctrl-C in a
    // terminal ends only this program. If false, it shares them with this program.
    bool is_apart = true;
};

// Starts the program. Returns the process, which the caller must wait for.
[[nodiscard]] Result<pid_t> spawn(const std::filesystem::path& program,
                                  const std::vector<std::string>& arguments,
                                  const SpawnOptions& options = {});

// Returns the path of the program of this name: beside this program, else on PATH; empty if there
// is none.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

}  // namespace stormcellar
