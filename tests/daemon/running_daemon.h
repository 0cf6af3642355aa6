// tests/daemon/running_daemon.h -- the real stormcellard on directories of its own.
//
// root/drop, root/state, root/cache and root/stormcellard.toml; its log goes to root/log. The
// process is killed when the object goes.
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

#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {

class RunningDaemon {
  public:
    // Makes the directories; start() starts the program.
    RunningDaemon();
    RunningDaemon(const RunningDaemon&) = delete;
    RunningDaemon& operator=(const RunningDaemon&) = delete;
    ~RunningDaemon();

    // `more` is added to the configuration, which names the paths, `options` to the command line;
    // throws when it cannot start.
    void start(const std::string& more = {},
               const std::map<std::string, std::string>& environment = {},
               const std::vector<std::string>& options = {});
    // Started by this program, which must become it (setpriv, unshare); before start().
    void run_under(std::vector<std::string> program) { under_ = std::move(program); }
    [[nodiscard]] pid_t id() const { return child_; }
    // The most memory that it has had resident; -1 where that cannot be read.
    [[nodiscard]] long peak_mib() const;
    void signal(int number) const;
    // The exit status, or minus the signal that ended it. Throws after 60 s.
    int wait();
    // The same at once; none while it runs.
    std::optional<int> ended();
    int terminate();

    [[nodiscard]] std::filesystem::path root() const { return root_.path(); }
    [[nodiscard]] std::filesystem::path drop() const { return root_ / "drop"; }
    [[nodiscard]] std::filesystem::path catalog() const { return root_ / "state/catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return root_ / "cache"; }
    [[nodiscard]] std::string log() const;
    // Null when there is none yet. `name`: below root/state.
    [[nodiscard]] nlohmann::json status(const std::string& name = "status.json") const;
    // False when it does not come true within a minute.
    bool wait_for(const std::function<bool(const nlohmann::json&)>& status,
                  const std::string& name = "status.json") const;
    bool wait_for_log(const std::string& text) const;

  private:
    testing::TemporaryDirectory root_;
    std::vector<std::string> under_;
    pid_t child_ = 0;
};

}  // namespace stormcellar::daemon
