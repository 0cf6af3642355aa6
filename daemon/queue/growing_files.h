// daemon/queue/growing_files.h -- files that are not whole yet, and when to look at them again.
//
// Two kinds. A NEW file was made and not closed (a writer that keeps it open; a hard link), or was
// written a moment ago when a scan found it: it is looked at when it has stood unchanged for
// `settle`, or after `busy` when it never rests. An INCOMPLETE file was looked at and its volume
// has not ended: it is looked at again when it has changed and settled, and finished as it is when
// it has been quiet (no change of size, time or inode) for `quiet`.
// Changes are seen by polling the stamps, which works for files that are never closed and on file
// systems without events. At most `limit` files are kept: at the bound a file takes the place of
// one of the station that has most, where its own has fewer; else it is left to the next scan. Pure
// bookkeeping: the caller gives the time (a monotonic clock) and the stamps. Thread contract: one
// thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/steady_time.h"
#include "daemon/watch/file_stamp.h"

namespace stormcellar::daemon {

class GrowingFiles {
  public:
    using Duration = SteadyTime::duration;
    static constexpr Duration settle = std::chrono::seconds{1};  // also how often stamps are read
    // So many stamps are read in a second: of more files each has its turn less often.
    static constexpr std::size_t most_looks = 512;
    static constexpr std::size_t most_looks_at_once = 64;
    // A writer that keeps its file open at a great pace is to be followed soon; a large copy is
    // looked at once in vain.
    static constexpr Duration busy = std::chrono::seconds{3};
    // A file that is followed shows its sweeps anyway, and to finish it is to begin it anew when
    // more comes after all: it is given so many times `quiet`.
    static constexpr int patience = 10;

    GrowingFiles(Duration quiet, std::size_t limit) : quiet_(quiet), limit_(limit) {}

    void set_quiet(Duration quiet) { quiet_ = quiet; }
    // False when there is no room left. A file that is known keeps its times. `station`: empty for
    // all of which none is known.
    bool add_new(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                 const std::string& station = {});
    // `stamp` as it was before the file was read; none: it is gone, and is asked for again all the
    // same, as a volume of chunks waits in its name. Replaces what was known of the path.
    bool add_incomplete(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                        bool followed = false, const std::string& station = {});
    void forget(const std::filesystem::path& path);
    // Those that had to give their places to others since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }

    struct Due {
        std::filesystem::path path;
        FileStamp stamp;
        bool finish_as_is = false;
    };
    // Reads the stamps when a poll is due; what it returns is no longer kept. A file that vanished
    // or became something else is forgotten, and an incomplete one is due: others may wait for it.
    using Look = std::function<FileFound(const std::filesystem::path&)>;
    std::vector<Due> poll(SteadyTime now, const Look& look);

    // Files whose volume has no end and to which nothing comes: how long until each is taken in as
    // it is. At most so many, the soonest first.
    struct Wait {
        std::string file;
        Duration left{};
    };
    [[nodiscard]] std::vector<Wait> waits(SteadyTime now, std::size_t most) const;

    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    [[nodiscard]] bool contains(const std::filesystem::path& path) const {
        return files_.contains(path.native());
    }
    [[nodiscard]] std::size_t count() const { return files_.size(); }
    // When the file was last looked at and found incomplete; none for all others.
    [[nodiscard]] std::optional<SteadyTime> found_incomplete_at(
        const std::filesystem::path& path) const;

  private:
    struct File {
        FileStamp looked_at;  // incomplete: the stamp that was ingested
        FileStamp last;
        SteadyTime since;       // when it was added
        SteadyTime changed_at;  // when `last` was first seen
        bool incomplete = false;
        bool followed = false;
        std::string station = {};
    };
    // By their names as text: to compare paths part by part takes ten times as long.
    using Files = std::map<std::string, File>;
    bool has_room_for(const std::string& station);
    void add(const std::filesystem::path& path, File file, SteadyTime now);
    // Looks at a file whose turn it is; gives the next one.
    Files::iterator look_at(Files::iterator entry, SteadyTime now, const Look& look,
                            std::vector<Due>& due);
    Files::iterator erase(Files::iterator file);
    [[nodiscard]] std::optional<Due> decide(const std::filesystem::path& path, const File& file,
                                            SteadyTime now) const;

    Duration quiet_;
    std::size_t limit_;
    SteadyTime next_poll_{};
    Files files_;
    std::map<std::string, std::set<std::string>> by_station_;
    std::string next_name_;       // where the next poll goes on
    std::size_t looks_left_ = 0;  // of the round that has begun
    SteadyTime next_round_{};
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon
