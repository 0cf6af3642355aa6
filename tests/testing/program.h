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

// Runs the program to its end. Throws std::runtime_error if the program cannot be started.
[[nodiscard]] ProgramResult run_program(const fs::path& program,
                                        const std::vector<std::string>& arguments);

// Starts the program, waits at most a minute until `seen` returns true, sends SIGINT and waits for
// the end. Returns the signal that ended the program, or 0 if it exited. The program writes to the
// test's own output.
[[nodiscard]] int interrupt_program(const fs::path& program,
                                    const std::vector<std::string>& arguments,
                                    const std::function<bool()>& seen);

// A program that runs beside the test. The destructor kills it.
class RunningProgram {
  public:
    RunningProgram(const fs::path& program, const std::vector<std::string>& arguments);
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;
    ~RunningProgram();

    [[nodiscard]] pid_t id() const { return child_; }
    [[nodiscard]] std::string out() const;
    [[nodiscard]] std::string err() const;
    // Waits at most a minute until `seen` returns true. Returns false if it never does.
    static bool wait_for(const std::function<bool()>& seen);
    // Sends the signal and waits for the end. Returns the exit status, or minus the signal that
    // ended the program.
    int end(int signal);

  private:
    TemporaryDirectory directory_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::testing
