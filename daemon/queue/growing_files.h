// daemon/queue/growing_files.h -- files that are not complete yet, and when to look at them again.
//
// There are two kinds. A NEW file was created and not closed (by a writer that keeps it open, or as
// a hard link), or was written just before a scan found it. It is offered when it has not changed
// for `settle`, or after `busy` if it never rests. An INCOMPLETE file was offered before, and its
// volume has not ended. It is offered again when it has changed and settled, and finished with what
// it has when it has been quiet (no change of size, time or inode) for `quiet`. Changes are found
// by polling the stamps. That also works for files that are never closed and on file systems
// without events. At most `limit` files are held. At that bound a file takes the place of a file of
// the station that has most, if its own station has fewer; otherwise the next scan finds it. Pure
// bookkeeping: the caller passes the time (of a monotonic clock) and the stamps. Thread contract:
// one thread.
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
    // How many stamps are read in a second: with more files each is read less often.
    static constexpr std::size_t most_looks = 512;
    static constexpr std::size_t most_looks_at_once = 64;
    // A writer that keeps its file open and writes fast should be followed soon; looking once at a
    // large copy in vain costs little.
    static constexpr Duration busy = std::chrono::seconds{3};
    // A followed file shows its sweeps anyway, and if it is finished too early it must be read anew
    // from its beginning. So it gets this many times `quiet`.
    static constexpr int patience = 10;

    GrowingFiles(Duration quiet, std::size_t limit) : quiet_(quiet), limit_(limit) {}

    void set_quiet(Duration quiet) { quiet_ = quiet; }
    // Returns false if there is no room. A file that is known keeps its times. `station` is empty
    // for all files of no known station.
    bool add_new(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                 const std::string& station = {});
    // `stamp` is that from before the file was read. None: the file is gone, but must be polled
    // because it represents a volume of chunks. Replaces what was known of the path.
    bool add_incomplete(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                        bool followed = false, const std::string& station = {});
    void forget(const std::filesystem::path& path);
    // The files that gave their places to others since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }

    struct Due {
        std::filesystem::path path;
        FileStamp stamp;
        bool finish_as_is = false;
    };
    // Reads the stamps when a poll is due. Files that it returns are no longer held. A file that is
    // gone or became something else is dropped; if it was incomplete it is returned, because it may
    // represent a volume of chunks.
    using Look = std::function<FileFound(const std::filesystem::path&)>;
    std::vector<Due> poll(SteadyTime now, const Look& look);

    // Files whose volume has not ended and that do not grow: how long until each is finished with
    // what it has. At most this many, the soonest first.
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
    // When the file was last read and found incomplete; none for all others.
    [[nodiscard]] std::optional<SteadyTime> found_incomplete_at(
        const std::filesystem::path& path) const;

  private:
    struct File {
        FileStamp looked_at;  // incomplete: the stamp of the file when it was read
        FileStamp last;
        SteadyTime since;       // when it was added
        SteadyTime changed_at;  // when `last` was first seen
        bool incomplete = false;
        bool followed = false;
        std::string station = {};
    };
    // By their names as text: comparing paths part by part takes ten times as long.
    using Files = std::map<std::string, File>;
    bool has_room_for(const std::string& station);
    void add(const std::filesystem::path& path, File file, SteadyTime now);
    // Looks at the file whose turn it is, and returns the next one.
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
    std::string next_name_;       // where the next poll continues
    std::size_t looks_left_ = 0;  // in the current round
    SteadyTime next_round_{};
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon
