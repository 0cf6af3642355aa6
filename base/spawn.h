// base/spawn.h -- starts a program with chosen input and output.
//
// The program inherits only the three descriptors of its input, output and errors.
//
// Threads   Any thread may call.
// Errors    not_found, permission or io if the program could not be started.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar {

struct SpawnOptions {
    // The descriptors that become the program's input, output and errors; negative: /dev/null.
    int in = -1, out = -1, err = -1;
    // If true, the new program has its own process group and default handling of signals, so that
    // Ctrl-C in a terminal does not reach it. If false, the program inherits its group and its
    // handling of signals.
    bool is_apart = true;
};

// Starts the program, and returns the id of its process. The caller must wait for the process.
[[nodiscard]] Result<pid_t> spawn(const std::filesystem::path& program,
                                  const std::vector<std::string>& arguments,
                                  const SpawnOptions& options = {});

// Returns the path of the program of this name in this program's directory, or else on PATH; empty
// if there is none.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

}  // namespace stormcellar
