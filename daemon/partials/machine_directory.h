// daemon/partials/machine_directory.h -- watches for partials in the directory of one machine.
//
// A partial is one site's grid for a mosaic. The directory has the layout of a cache. Files that
// are not named like partials, such as temporary files of rsync, are ignored. This class writes
// nothing into the directory. A partial is "news" until take_news() returns it, and becomes news
// again when its file is replaced.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/watch/watcher.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::daemon {

class MachineDirectory final : public WatchListener {
  public:
    MachineDirectory(std::filesystem::path directory, std::unique_ptr<EventSource> events);

    [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
    [[nodiscard]] std::string name() const { return directory_.filename().native(); }
    [[nodiscard]] int descriptor() const { return events_->descriptor(); }
    void read_events() { watcher_.read_events(); }
    // Looks at all files of the directory. Fails if the directory cannot be read.
    Status scan();
    // Returns true if a scan is needed, because events were lost since the last call or directories
    // were not read.
    bool take_lost() { return std::exchange(is_lost_, false); }
    [[nodiscard]] bool is_blind() const { return watcher_.is_blind(); }

    // Returns the newest partial that is news, or none. The partial is then no longer news.
    std::optional<cache::GridName> take_news();
    // Makes the next scan report the partial as news again.
    void forget(const cache::GridName& name) { seen_.erase(name); }
    // Ignores a partial until its file is replaced.
    void refuse(const cache::GridName& name);
    // Returns true if the machine has the partial, and it was not refused.
    [[nodiscard]] bool has(const cache::GridName& name) const;
    // Returns the partials that were seen and are neither news nor refused.
    [[nodiscard]] std::vector<cache::GridName> known() const;

    void file_closed(const std::filesystem::path& path, const FileStamp& stamp) override;
    void file_created(const std::filesystem::path& path, const FileStamp& stamp) override;
    void file_found(const std::filesystem::path& path, const FileStamp& stamp) override;
    void file_gone(const std::filesystem::path& path) override;
    void events_lost() override { is_lost_ = true; }
    void directory_unread() override { is_lost_ = true; }
    void drop_vanished() override { is_lost_ = true; }
    void directory_problem(const Error&) override {}

  private:
    struct Newest {
        bool operator()(const cache::GridName& a, const cache::GridName& b) const {
            return a.time != b.time ? a.time > b.time : a < b;
        }
    };
    [[nodiscard]] std::optional<cache::GridName> name_of(const std::filesystem::path& path) const;
    void look(const std::filesystem::path& path, const FileStamp& stamp);

    std::filesystem::path directory_;
    std::unique_ptr<EventSource> events_;
    struct Seen {
        FileStamp stamp;
        bool is_refused = false;
    };
    std::map<cache::GridName, Seen> seen_;
    std::set<cache::GridName, Newest> news_;
    bool is_lost_ = false;
    Watcher watcher_;  // declared last: it calls this object
};

}  // namespace stormcellar::daemon
