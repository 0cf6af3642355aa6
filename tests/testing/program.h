// tests/testing/program.h -- runs a program as a user would and keeps what it printed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stormcellar::testing {

struct ProgramResult {
    int status = -1;  // exit status; -1 when a signal ended it
    std::string out;
    std::string err;
};

// Waits for the program to end. Throws std::runtime_error when it cannot be started.
[[nodiscard]] ProgramResult run_program(const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments);

// Starts the program, waits until `seen` holds (at most a minute), sends it SIGINT and waits for
// its end: the number of the signal that ended it, 0 when it ended by itself. Its output is the
// test's.
[[nodiscard]] int interrupt_program(const std::filesystem::path& program,
                                    const std::vector<std::string>& arguments,
                                    const std::function<bool()>& seen);

}  // namespace stormcellar::testing
