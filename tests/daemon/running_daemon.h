// tests/daemon/running_daemon.h -- runs the real stormcellard on directories of its own.
//
// The directories are root/drop, root/state and root/cache. The configuration is
// root/stormcellard.toml, and the log goes to root/log. The process is killed when the object is
// destroyed.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "tests/daemon/notify_socket.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {

class RunningDaemon {
  public:
    // Makes the directories; start() starts the program.
    RunningDaemon();
    RunningDaemon(const RunningDaemon&) = delete;
    RunningDaemon& operator=(const RunningDaemon&) = delete;
    ~RunningDaemon();

    // Starts the program. Adds `more` to the configuration, which has the paths, and `options` to
    // the command line. Throws if the program cannot be started.
    void start(const std::string& more = {},
               const std::map<std::string, std::string>& environment = {},
               const std::vector<std::string>& options = {});
    // Makes start() run the daemon through this program, which must replace itself by the daemon
    // (setpriv, unshare).
    void run_under(std::vector<std::string> program) { under_ = std::move(program); }
    [[nodiscard]] pid_t id() const { return child_; }
    // Returns the daemon's peak resident memory; -1 if it cannot be read.
    [[nodiscard]] long peak_mib() const;
    void signal(int number) const;
    // Waits for the end of the daemon. Returns the exit status, or minus the signal that ended the
    // daemon. Throws after 60 s.
    int wait();
    // Returns what wait() returns, but does not wait; none while the daemon runs.
    std::optional<int> ended();
    int terminate();
    // Expects that the daemon reports a reload and its end to the service manager.
    void expect_reload_and_end(NotifySocket& manager);

    // Writes root/scene.toml, a small picture.
    void write_scene() const;

    [[nodiscard]] std::filesystem::path root() const { return root_.path(); }
    [[nodiscard]] std::filesystem::path drop() const { return root_ / "drop"; }
    [[nodiscard]] std::filesystem::path catalog() const { return root_ / "state/catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return root_ / "cache"; }
    [[nodiscard]] std::string log() const;
    // Returns the status document root/state/`name`; null if there is none yet.
    [[nodiscard]] nlohmann::json status(const std::string& name = "status.json") const;
    // Waits until the condition is true. Returns false if that takes more than a minute.
    bool wait_for(const std::function<bool(const nlohmann::json&)>& status,
                  const std::string& name = "status.json") const;
    bool wait_for_log(const std::string& text) const;

  private:
    testing::TemporaryDirectory root_;
    std::vector<std::string> under_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::daemon
