// tests/testing/program.h -- runs a program as a user would and keeps what it printed.
#pragma once

#include <filesystem>
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

}  // namespace stormcellar::testing
