// web/data/grids/cache_tree.h -- the directories of a cache, for the watch of the cache.
//
// A CacheTree reads directories, sets watches on them, and reports grids that came, went or
// changed. Like the store, it follows no symbolic links below the cache's directory.
//
// Threads   One thread at a time.
// Errors    A directory that cannot be read keeps its known contents; see is_blind().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "web/data/grids/cache_watch.h"

namespace stormcellar::web {

class CacheTree {
  public:
    // `notify` is an inotify descriptor, or -1 to watch nothing.
    CacheTree(std::filesystem::path cache, int notify, CacheWatch::Listener listener);

    // Reads each directory that is new, or whose time has changed since it was read.
    void scan();
    // Handles bytes that were read from the inotify descriptor. Returns false if events were lost,
    // or if the cache itself was moved or removed; the caller must then call scan().
    [[nodiscard]] bool take(const char* events, std::size_t size);

    [[nodiscard]] bool is_there() const { return is_there_; }
    // Returns true if some directory could not be watched, or could not be read.
    [[nodiscard]] bool is_blind() const { return blind_; }
    // Call it after events were lost. Reports that everything may have changed, and makes the next
    // scan() read every directory.
    void forget_times();
    // Reports that everything may have changed.
    void tell_everything();

  private:
    // The state of a directory when it was last read.
    struct Seen {
        int watch = -1;
        std::uint64_t device = 0, inode = 0;
        std::int64_t modified_ns = 0;
        std::int64_t read_ns = 0;  // by the clock that dates files
    };
    struct Day {
        Seen seen;
        std::vector<UtcTime> times;  // ascending
        // The last grid that an event reported as gone. More events of its removal may follow.
        std::optional<UtcTime> gone;
    };
    struct OfMoment {
        Seen seen;
        std::map<std::string, Day> days;
    };
    struct OfDomain {
        Seen seen;
        std::map<level2::Moment, OfMoment> moments;
    };
    // Names a watched directory: the cache (no domain), a domain (no moment), a moment (no day) or
    // a day.
    struct Place {
        std::string domain;
        std::optional<level2::Moment> moment;
        std::string day;
    };

    [[nodiscard]] std::filesystem::path path_of(const Place& place) const;
    // Watches the directory and notes its time. Returns true if its names must be read, and none if
    // it does not exist.
    std::optional<bool> look(const Place& place, Seen& seen);
    void scan_domain(const std::string& domain);
    void scan_moment(const std::string& domain, level2::Moment moment);
    void scan_day(const Place& place);
    void compare_day(const Place& place, Day& day, const std::vector<std::string>& names,
                     std::int64_t read_before_ns);
    void drop_domain(const std::string& domain);
    void drop_moment(const std::string& domain, level2::Moment moment);
    void drop_day(const Place& place);
    void drop_all();
    void unwatch(Seen& seen);
    void handle(int watch, std::uint32_t mask, std::string_view name);
    void handle_directory(const Place& place, std::uint32_t mask, const std::string& name);
    void handle_file(const Place& place, std::uint32_t mask, std::string_view name);
    void note_time(const Place& place, Seen& seen) const;
    [[nodiscard]] Day* find_day(const Place& place);
    void tell(CacheEvent event, const Place& place, UtcTime time) const;

    std::filesystem::path cache_;
    int notify_;
    CacheWatch::Listener listener_;
    bool is_there_ = false, blind_ = false, root_gone_ = false;
    Seen root_;
    std::map<std::string, OfDomain> domains_;
    std::unordered_map<int, Place> places_;
};

}  // namespace stormcellar::web
