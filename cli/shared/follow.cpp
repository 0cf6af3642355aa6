#include "cli/shared/follow.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/shared/commands.h"

namespace stormcellar::cli {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds between_looks{200};
constexpr std::chrono::milliseconds quiet_time{250};
constexpr std::chrono::seconds longest_burst{3};

// Values that change whenever a file or directory changes. All are zero if it does not exist.
struct Stamp {
    std::string path;
    std::uint64_t inode = 0;
    std::int64_t changed_s = 0, changed_ns = 0, bytes = 0;
    bool operator==(const Stamp&) const = default;
};

Stamp stamp_of(const std::filesystem::path& path) {
    struct stat found {};
    if (::stat(path.c_str(), &found) != 0) return {path.native()};
    return {path.native(), found.st_ino, found.st_mtim.tv_sec, found.st_mtim.tv_nsec,
            found.st_size};
}

// Returns the stamps of the directories of the domain, of the moment, and of the moment's days.
std::vector<Stamp> directories_of(const Following& following) {
    const auto domain = following.cache / following.domain;
    const auto moment = domain / std::string(level2::moment_name(following.moment));
    std::vector<Stamp> stamps{stamp_of(domain), stamp_of(moment)};
    std::error_code error;
    for (std::filesystem::directory_iterator day(moment, error), end; !error && day != end;
         day.increment(error)) {
        stamps.push_back(stamp_of(day->path()));
    }
    return stamps;
}

std::vector<Stamp> stamps_of(const std::vector<cache::StoreEntry>& grids) {
    std::vector<Stamp> stamps;
    stamps.reserve(grids.size());
    for (const cache::StoreEntry& grid : grids)
        stamps.push_back(stamp_of(grid.path));
    return stamps;
}

// Detects changes of the directories.
class Changes {
  public:
    explicit Changes(const Following& following) : following_(following) {}

    // Waits for a change, and then until the changes pause. The first call waits only for the
    // pause. Returns false if the flag was set.
    bool wait(const std::atomic<bool>& stop) {
        std::optional<SteadyClock::time_point> began;
        SteadyClock::time_point last;
        while (!stop) {
            const auto now = SteadyClock::now();
            if (auto seen = directories_of(following_); !known_ || *known_ != seen) {
                known_ = std::move(seen);
                last = now;
                if (!began) began = now;
            }
            if (began && now - last >= quiet_time) return true;
            if (began && now - *began >= longest_burst) {
                // Another change within the same tick of the file system's clock would leave the
                // stamps unchanged, so look again.
                known_.reset();
                return true;
            }
            std::this_thread::sleep_for(began ? between_looks / 4 : between_looks);
        }
        return false;
    }

  private:
    const Following& following_;
    std::optional<std::vector<Stamp>> known_;
};

// Makes the kernel send SIGTERM when the parent ends. Returns false if the parent has ended
// already.
bool end_with(pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    return ::getppid() == parent;
}

}  // namespace

void add_follow_options(CLI::App& app, FollowOptions& options) {
    app.add_flag("--follow", options.wanted,
                 "Keep running, and make the loop again whenever its grids change");
    // This option is hidden. stormcellard uses it for children that must end when the daemon ends.
    app.add_option("--with-parent", options.parent, "End when the process of this number ends")
        ->group("");
}

int follow(const Following& following, const FollowOptions& options,
           const std::atomic<bool>& stop) {
    if (options.parent != 0 && !end_with(options.parent)) return exit_done;
    Changes changes(following);
    std::optional<std::vector<Stamp>> made_of;
    bool is_waiting = false;
    bool is_first = true;
    while (is_first || changes.wait(stop)) {
        is_first = false;
        const auto grids = following.find();
        if (!grids) {
            const int status = report_error(grids.error());
            if (status == exit_bad_usage && !made_of) return status;
            continue;
        }
        if (grids->empty()) {
            if (!is_waiting && !following.quiet) {
                std::error_code ignored;
                const bool has_cache = std::filesystem::exists(following.cache, ignored);
                print_note(fmt::format(
                    "{}there is no grid of domain '{}' yet; waiting for one",
                    has_cache ? "" : following.cache.native() + ": there is no cache here yet; ",
                    following.domain));
            }
            is_waiting = true;
            continue;
        }
        is_waiting = false;
        auto stamps = stamps_of(*grids);
        if (made_of == stamps) continue;
        const int status = following.make(*grids);
        if (status == exit_bad_usage && !made_of) return status;
        if (status == exit_done) made_of = std::move(stamps);
    }
    return exit_done;
}

void print_json_line(const nlohmann::json& document) {
    fmt::print("{}\n", document.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
    std::fflush(stdout);
}

}  // namespace stormcellar::cli
