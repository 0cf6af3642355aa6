// tests/testing/program.h -- runs a program as a user would and keeps what it printed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/testing/temporary_directory.h"

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

// A program that goes on beside the test. Killed when the object goes.
class RunningProgram {
  public:
    RunningProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments);
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;
    ~RunningProgram();

    [[nodiscard]] pid_t id() const { return child_; }
    // What it has printed so far.
    [[nodiscard]] std::string out() const;
    [[nodiscard]] std::string err() const;
    // Looks again and again for at most a minute; false when it does not come true.
    static bool wait_for(const std::function<bool()>& seen);
    // Sends the signal and waits: the exit status, or minus the signal that ended it.
    int end(int signal);

  private:
    TemporaryDirectory directory_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::testing
