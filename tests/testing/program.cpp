#include "tests/testing/program.h"

#include <csignal>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

extern char** environ;

namespace stormcellar::testing {
namespace {

pid_t start(const fs::path& program, const std::vector<std::string>& arguments,
            const posix_spawn_file_actions_t* actions) {
    std::string name = program.string();
    std::vector<std::string> copies = arguments;
    std::vector<char*> argv = {name.data()};
    for (std::string& copy : copies)
        argv.push_back(copy.data());
    argv.push_back(nullptr);
    // A test that a script runs in the background inherits an ignored SIGINT, but the programs that
    // the test starts must not ignore SIGINT.
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &ends);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, name.c_str(), actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) {
        throw std::runtime_error("cannot start " + name);
    }
    return child;
}

// Starts the program without input. Its output goes to the files out and err of the directory.
pid_t start_quietly(const fs::path& program, const std::vector<std::string>& arguments,
                    const fs::path& directory) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, (directory / "out").c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, (directory / "err").c_str(), flags, 0600);
    const pid_t child = start(program, arguments, &actions);
    posix_spawn_file_actions_destroy(&actions);
    return child;
}

}  // namespace

ProgramResult run_program(const fs::path& program, const std::vector<std::string>& arguments) {
    const TemporaryDirectory directory;
    const pid_t child = start_quietly(program, arguments, directory.path());
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(directory / "out"),
            file_text(directory / "err")};
}

int interrupt_program(const fs::path& program, const std::vector<std::string>& arguments,
                      const std::function<bool()>& seen) {
    const pid_t child = start(program, arguments, nullptr);
    (void)eventually(seen);
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

RunningProgram::RunningProgram(const fs::path& program, const std::vector<std::string>& arguments)
    : child_(start_quietly(program, arguments, directory_.path())) {}

RunningProgram::~RunningProgram() {
    if (child_ != 0) end(SIGKILL);
}

std::string RunningProgram::out() const {
    return file_text(directory_ / "out");
}

std::string RunningProgram::err() const {
    return file_text(directory_ / "err");
}

bool RunningProgram::wait_for(const std::function<bool()>& seen) {
    return eventually(seen);
}

int RunningProgram::end(int signal) {
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace stormcellar::testing
