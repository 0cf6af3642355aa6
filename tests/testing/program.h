// tests/testing/program.h -- runs a program as a user does and keeps its output.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {

struct ProgramResult {
    int status = -1;  // exit status; -1 if a signal ended it
    std::string out;
    std::string err;
};

// Waits for the program to end. Throws std::runtime_error if it cannot be started.
[[nodiscard]] ProgramResult run_program(const fs::path& program,
                                        const std::vector<std::string>& arguments);

// Starts the program, waits until `seen` returns true (at most a minute), sends it SIGINT and waits
// for its end. Returns the number of the signal that ended it, 0 if it ended by itself. Its output
// is that of the test.
[[nodiscard]] int interrupt_program(const fs::path& program,
                                    const std::vector<std::string>& arguments,
                                    const std::function<bool()>& seen);

// A program that runs beside the test. Killed when the object is destroyed.
class RunningProgram {
  public:
    RunningProgram(const fs::path& program, const std::vector<std::string>& arguments);
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;
    ~RunningProgram();

    [[nodiscard]] pid_t id() const { return child_; }
    // Returns its output so far.
    [[nodiscard]] std::string out() const;
    [[nodiscard]] std::string err() const;
    // Checks repeatedly for at most a minute. Returns false if it does not become true.
    static bool wait_for(const std::function<bool()>& seen);
    // Sends the signal and waits. Returns the exit status, or minus the signal that ended it.
    int end(int signal);

  private:
    TemporaryDirectory directory_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::testing
