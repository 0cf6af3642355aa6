#include "bench/process.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/measure.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds step{20};
constexpr int steps_to_start = 3000;

// Becomes the program. Uses only calls that are safe in the child of a process with threads.
[[noreturn]] void become(const std::vector<char*>& words, const char* output, const char* errors,
                         const cpu_set_t* processors, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The signal comes only if the parent ends after the call of prctl().
    if (::getppid() != parent) ::_exit(127);
    if (processors) ::sched_setaffinity(0, sizeof *processors, processors);
    const int out = ::open(output, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    const int err = ::open(errors, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (out < 0 || err < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0) ::_exit(127);
    ::execvp(words.front(), words.data());
    ::_exit(127);
}

}  // namespace

std::string text_in(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

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
    return text_in(output_);
}

double ChildProcess::cpu_s() const {
    std::ifstream file(fmt::format("/proc/{}/stat", child_));
    std::string line;
    std::getline(file, line);
    // Skip the program's name, which is in parentheses and may contain spaces. After the name,
    // utime and stime are the 12th and 13th words (proc(5)).
    std::istringstream words(line.substr(std::min(line.rfind(')') + 1, line.size())));
    std::string word;
    for (int i = 0; i < 11; ++i)
        words >> word;
    double user = 0, system = 0;
    words >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

bool ChildProcess::wait_until_idle(std::chrono::seconds most) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    auto busy = start;
    double before_s = cpu_s();
    while (Clock::now() - busy < std::chrono::seconds{1}) {
        if (Clock::now() - start > most || !is_running()) return false;
        std::this_thread::sleep_for(step);
        const double now_s = cpu_s();
        if (now_s > before_s) busy = Clock::now();
        before_s = now_s;
    }
    return true;
}

double ChildProcess::memory_mib(std::string_view line) const {
    std::ifstream file(fmt::format("/proc/{}/status", child_));
    for (std::string text; std::getline(file, text);) {
        if (text.starts_with(line))
            return static_cast<double>(number_in(std::string_view{text}.substr(line.size() + 1))) /
                   1024;
    }
    return 0;
}

DaemonProcess::DaemonProcess(fs::path root)
    : DaemonProcess(std::move(root), built_program("daemon/stormcellard")) {}

Status DaemonProcess::start(const std::string& configuration) {
    std::error_code failed;
    fs::create_directories(drop(), failed);
    const std::string file = root_ / "stormcellard.toml";
    std::ofstream(file) << "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n"
                        << configuration;
    if (::access(program_.c_str(), X_OK) != 0) {
        return fail(ErrorCode::not_found, "{} cannot be started: build stormcellard",
                    program_.native());
    }
    auto child = ChildProcess::start({program_, "--config", file}, root_ / "log");
    if (!child) return pass_on(child);
    child_.emplace(std::move(*child));
    for (int i = 0; i < steps_to_start && is_running(); ++i) {
        if (status().state == "running") return {};
        std::this_thread::sleep_for(step);
    }
    return fail(ErrorCode::internal, "stormcellard did not start: {}",
                (root_ / "log.err").native());
}

DaemonStatus DaemonProcess::status() const {
    std::ifstream file(root_ / "state/status.json");
    const auto said = nlohmann::json::parse(file, nullptr, false);
    DaemonStatus status;
    if (!said.is_object()) return status;
    status.state = said.value("state", "");
    if (const auto pending = said.find("pending"); pending != said.end()) {
        status.waiting = pending->value("waiting", std::size_t{0});
        status.running = pending->value("running", std::size_t{0});
    }
    if (const auto rolling = said.find("rolling"); rolling != said.end() && rolling->is_object())
        status.cache_bytes = rolling->value("bytes", std::uint64_t{0});
    status.failures = said.value("failures", std::uint64_t{0});
    status.overflows = said.value("overflows", std::uint64_t{0});
    return status;
}

DaemonMemory DaemonProcess::memory() const {
    return {child_->memory_mib(), child_->memory_mib("RssAnon"), child_->memory_mib("RssFile")};
}

void DaemonProcess::reset_peak() const {
    std::ofstream(fmt::format("/proc/{}/clear_refs", id())) << "5";
}

}  // namespace stormcellar::bench
