#include "bench/daemon_process.h"

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/measure.h"

extern char** environ;

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds step{20};
constexpr int steps_to_start = 3000;

fs::path program_beside() {
    std::error_code failed;
    const auto own = fs::read_symlink("/proc/self/exe", failed);
    return own.parent_path().parent_path() / "daemon" / "stormcellard";
}

double mib_in(std::string_view line) {
    return static_cast<double>(number_in(line.substr(line.find(':') + 1))) / 1024;
}

// Uses only calls that are safe in the child of a process with threads. Returns -1 if it fails.
pid_t fork_daemon(const std::string& program, const std::string& configuration,
                  const std::string& log) {
    std::string path = program, option = "--config", file = configuration;
    const std::array<char*, 4> arguments = {path.data(), option.data(), file.data(), nullptr};
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent may have ended before this call; then no signal would come.
    if (::getppid() != parent) ::_exit(127);
    const int said = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (said < 0 || ::dup2(said, 2) < 0) ::_exit(127);
    ::execve(path.c_str(), arguments.data(), environ);
    ::_exit(127);
}

}  // namespace

DaemonProcess::DaemonProcess(fs::path root) : DaemonProcess(std::move(root), program_beside()) {}

DaemonProcess::~DaemonProcess() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
}

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
    const std::string log = root_ / "log";
    child_ = fork_daemon(program_, file, log);
    if (child_ < 0) {
        child_ = 0;
        return fail(ErrorCode::io, "{} cannot be started: no process to be had", program_.native());
    }
    for (int i = 0; i < steps_to_start && is_running(); ++i) {
        if (status().state == "running") return {};
        std::this_thread::sleep_for(step);
    }
    return fail(ErrorCode::internal, "stormcellard did not start: {}", log);
}

bool DaemonProcess::is_running() {
    if (child_ > 0 && ::waitpid(child_, nullptr, WNOHANG) == child_) child_ = 0;
    return child_ > 0;
}

bool DaemonProcess::stop() {
    if (child_ <= 0) return false;
    int status = -1;
    ::kill(child_, SIGTERM);
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
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
        status.growing = pending->value("growing", std::size_t{0});
    }
    if (const auto rolling = said.find("rolling"); rolling != said.end() && rolling->is_object()) {
        status.cache_bytes = rolling->value("bytes", std::uint64_t{0});
        status.grids = rolling->value("grids", std::uint64_t{0});
    }
    status.failures = said.value("failures", std::uint64_t{0});
    status.overflows = said.value("overflows", std::uint64_t{0});
    if (const auto latency = said.find("latency_s");
        latency != said.end() && latency->value("count", 0) > 0) {
        status.latency_median_s = latency->value("median", 0.0);
        status.latency_p95_s = latency->value("p95", 0.0);
    }
    return status;
}

double DaemonProcess::cpu_s() const {
    std::ifstream file(fmt::format("/proc/{}/stat", child_));
    std::string text;
    std::getline(file, text);
    // After the name, which may contain anything, there are the state, ten numbers, and then the
    // two numbers (proc(5)).
    std::istringstream words(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    std::string skipped;
    for (int i = 0; i < 11; ++i)
        words >> skipped;
    double user = 0, system = 0;
    words >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

DaemonMemory DaemonProcess::memory() const {
    DaemonMemory memory;
    std::ifstream file(fmt::format("/proc/{}/status", child_));
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("VmHWM:")) memory.peak_mib = mib_in(line);
        if (line.starts_with("RssAnon:")) memory.anonymous_mib = mib_in(line);
        if (line.starts_with("RssFile:")) memory.file_mib = mib_in(line);
    }
    return memory;
}

void DaemonProcess::reset_peak() const {
    std::ofstream(fmt::format("/proc/{}/clear_refs", child_)) << "5";
}

}  // namespace stormcellar::bench
