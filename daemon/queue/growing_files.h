// daemon/queue/growing_files.h -- files that are not complete yet, and when to check them again.
//
// There are two kinds. A NEW file was created and not closed (its writer keeps it open, or it is a
// hard link), or a scan found it a moment after it was written. It is ingested once it has been
// unchanged for `settle`, or after `busy` if it never rests. An INCOMPLETE file was ingested, but
// its volume has not ended. It is ingested again when it has changed and settled, and finished as
// it is when it has been quiet (no change of size, time or inode) for `quiet`.
//
// Changes are found by polling the stamps, which also works for files that are never closed and on
// file systems without events. At most `limit` files are kept. At the limit, a new file takes the
// place of a file of the station that has the most, if its own station has fewer; otherwise it is
// left to the next scan. This is pure bookkeeping: the caller passes the time (of a monotonic
// clock) and the stamps.
//
// Threads   One thread at a time.
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
    // also the period of reading stamps
    static constexpr Duration settle = std::chrono::seconds{1};
    // This many stamps are read in a second. If there are more files, each is polled less often.
    static constexpr std::size_t most_looks = 512;
    static constexpr std::size_t most_looks_at_once = 64;
    // A file that is kept open and written fast must be followed soon. The price is that a large
    // copy is ingested once in vain.
    static constexpr Duration busy = std::chrono::seconds{3};
    // The sweeps of a followed file are shown anyway, and a file that is finished too early must be
    // started anew when more comes. So it is given this many times `quiet`.
    static constexpr int patience = 10;

    GrowingFiles(Duration quiet, std::size_t limit) : quiet_(quiet), limit_(limit) {}

    void set_quiet(Duration quiet) { quiet_ = quiet; }
    // Returns false if there is no room left. A file that is already known keeps its times. All
    // unknown stations share the empty `station`.
    bool add_new(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                 const std::string& station = {});
    // Adds a file. `stamp` is its stamp from before it was read; none if the file is gone. A gone
    // file is still returned by polls, because the chunks of a volume wait under its name. Replaces
    // earlier information about the path.
    bool add_incomplete(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                        bool followed = false, const std::string& station = {});
    void forget(const std::filesystem::path& path);
    // Returns the files that lost their places to others since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }

    struct Due {
        std::filesystem::path path;
        FileStamp stamp;
        bool finish_as_is = false;
    };
    // Reads the stamps if a poll is due. A file that is returned is no longer kept. A file that
    // vanished or became something else is forgotten; if it was incomplete, it is returned as due,
    // since others may wait for it.
    using Look = std::function<FileFound(const std::filesystem::path&)>;
    std::vector<Due> poll(SteadyTime now, const Look& look);

    // Returns files whose volume has no end and to which nothing is added, with the time that
    // remains until each is ingested as it is: at most `most`, the soonest first.
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
    // Returns when the file was last ingested and found incomplete; none for all others.
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
    // By their paths as text: comparing paths part by part takes ten times as long.
    using Files = std::map<std::string, File>;
    bool has_room_for(const std::string& station);
    void add(const std::filesystem::path& path, File file, SteadyTime now);
    // Checks a file whose turn it is, and returns the next one.
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
    std::size_t looks_left_ = 0;  // of the current round
    SteadyTime next_round_{};
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon
