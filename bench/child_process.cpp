#include "bench/child_process.h"

#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/measure.h"

namespace stormcellar::bench {
namespace {

// Uses only calls that are safe in the child of a process with threads.
[[noreturn]] void become(const std::vector<char*>& words, const char* output, const char* errors,
                         const cpu_set_t* processors, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent may have ended before this call; then no signal would come.
    if (::getppid() != parent) ::_exit(127);
    if (processors) ::sched_setaffinity(0, sizeof *processors, processors);
    const int out = ::open(output, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    const int err = ::open(errors, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (out < 0 || err < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0) ::_exit(127);
    ::execvp(words.front(), words.data());
    ::_exit(127);
}

}  // namespace

Result<ChildProcess> ChildProcess::start(std::vector<std::string> arguments,
                                         std::filesystem::path output,
                                         std::optional<int> processor) {
    std::vector<char*> words;
    for (std::string& argument : arguments)
        words.push_back(argument.data());
    words.push_back(nullptr);
    const std::string errors = output.native() + ".err";
    cpu_set_t processors;
    CPU_ZERO(&processors);
    if (processor) CPU_SET(static_cast<std::size_t>(*processor), &processors);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0)
        become(words, output.c_str(), errors.c_str(), processor ? &processors : nullptr, parent);
    if (child < 0) return fail(ErrorCode::io, "{}: no process to be had", arguments.front());
    return ChildProcess{child, std::move(output)};
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : child_(std::exchange(other.child_, 0)), output_(std::move(other.output_)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
    std::swap(child_, other.child_);
    std::swap(output_, other.output_);
    return *this;
}

ChildProcess::~ChildProcess() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
}

bool ChildProcess::is_running() {
    if (child_ > 0 && ::waitpid(child_, nullptr, WNOHANG) == child_) child_ = 0;
    return child_ > 0;
}

bool ChildProcess::wait() {
    if (child_ <= 0) return false;
    int status = -1;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool ChildProcess::stop() {
    if (child_ > 0) ::kill(child_, SIGTERM);
    return wait();
}

std::string ChildProcess::output() const {
    std::ifstream file(output_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

double ChildProcess::cpu_s() const {
    std::ifstream file(fmt::format("/proc/{}/stat", child_));
    std::string line;
    std::getline(file, line);
    // The name of the program, in parentheses, may contain spaces. Behind it, utime and stime are
    // the 12th and 13th words (proc(5)).
    std::istringstream words(line.substr(std::min(line.rfind(')') + 1, line.size())));
    std::string word;
    for (int i = 0; i < 11; ++i)
        words >> word;
    double user = 0, system = 0;
    words >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

double ChildProcess::peak_mib() const {
    std::ifstream file(fmt::format("/proc/{}/status", child_));
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("VmHWM:"))
            return static_cast<double>(number_in(std::string_view{line}.substr(6))) / 1024;
    }
    return 0;
}

}  // namespace stormcellar::bench
