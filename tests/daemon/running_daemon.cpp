#include "tests/daemon/running_daemon.h"

#include <array>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/waiting.h"

extern char** environ;

namespace stormcellar::daemon {
namespace {

std::vector<std::string> environment_with(const std::map<std::string, std::string>& more) {
    std::vector<std::string> all;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (!more.contains(text.substr(0, text.find('=')))) all.push_back(text);
    }
    for (const auto& [name, value] : more)
        all.push_back(name + "=" + value);
    return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> all;
    for (std::string& text : texts)
        all.push_back(text.data());
    all.push_back(nullptr);
    return all;
}

}  // namespace

RunningDaemon::RunningDaemon() {
    std::filesystem::create_directory(drop());
}

RunningDaemon::~RunningDaemon() {
    if (child_ == 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
}

void RunningDaemon::start(const std::string& more,
                          const std::map<std::string, std::string>& environment,
                          const std::vector<std::string>& options) {
    const std::filesystem::path file = root_ / "stormcellard.toml";
    write_file(file, "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n" + more);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 2, (root_ / "log").c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
    std::vector<std::string> arguments = under_;
    arguments.insert(arguments.end(), {STORMCELLARD, "--config", file.native()});
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::vector<std::string> variables = environment_with(environment);
    const int failed = ::posix_spawnp(&child_, arguments.front().c_str(), &actions, nullptr,
                                      pointers(arguments).data(), pointers(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("cannot start stormcellard");
}

long RunningDaemon::peak_mib() const {
    std::ifstream status("/proc/" + std::to_string(child_) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::stol(line.substr(6)) / 1024;
    }
    return -1;
}

void RunningDaemon::signal(int number) const {
    ::kill(child_, number);
}

std::optional<int> RunningDaemon::ended() {
    int status = 0;
    if (child_ == 0 || ::waitpid(child_, &status, WNOHANG) != child_) return std::nullopt;
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

int RunningDaemon::wait() {
    std::optional<int> status;
    if (!testing::eventually([&] { return (status = ended()).has_value(); }))
        throw std::runtime_error("stormcellard does not end");
    return *status;
}

int RunningDaemon::terminate() {
    signal(SIGTERM);
    return wait();
}

void RunningDaemon::expect_reload_and_end(NotifySocket& manager) {
    signal(SIGHUP);
    EXPECT_TRUE(manager.hears("RELOADING=1\nMONOTONIC_USEC="));
    EXPECT_TRUE(manager.hears("READY=1"));
    signal(SIGTERM);
    EXPECT_TRUE(manager.hears("STOPPING=1"));
    EXPECT_EQ(wait(), 0) << log();
}

void RunningDaemon::write_scene() const {
    write_file(root() / "scene.toml",
               "[picture]\nproduct = \"composite\"\nwidth = 480\nheight = 360\n");
}

std::string RunningDaemon::log() const {
    std::ifstream file(root_ / "log", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json RunningDaemon::status(const std::string& name) const {
    std::ifstream file(root_ / "state" / name);
    if (!file) return nullptr;
    return nlohmann::json::parse(file);
}

bool RunningDaemon::wait_for(const std::function<bool(const nlohmann::json&)>& wanted,
                             const std::string& name) const {
    return testing::eventually([&] {
        const nlohmann::json now = status(name);
        return !now.is_null() && wanted(now);
    });
}

bool RunningDaemon::wait_for_log(const std::string& text) const {
    return testing::eventually([&] { return log().find(text) != std::string::npos; });
}

}  // namespace stormcellar::daemon
