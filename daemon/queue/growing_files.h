// daemon/queue/growing_files.h -- remembers files that are not complete yet, and when to check
// them.
//
// There are two kinds of files. A NEW file was created and is not closed (its writer keeps it open,
// or it is a hard link), or a scan found it a moment after it was written. It is ingested when it
// has been unchanged for `settle`, or after `busy` even if it still changes; an empty file is
// ingested only after `quiet`. An INCOMPLETE file was ingested, but its volume has not ended. If it
// has changed, it is ingested again when it has been unchanged for `settle`, or after `quiet` even
// if it still changes. If it has not changed for `quiet`, its volume is finished without its end.
// For a followed file, whose new data are read as they come, this time is `patience` times `quiet`.
//
// Changes are found by polling the stamps (time and size) of files. This also works for files that
// are never closed, and on file systems without events. At most `limit` files are kept. At the
// limit, a new file takes the place of a file of the station with the most files, if the new file's
// station has at least two files fewer; otherwise the caller leaves the new file to the next scan.
// This class does no input or output: the caller passes the time (of a monotonic clock) and the
// stamps.
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
    // The time that a file must be unchanged; also the time between polls of all stamps.
    static constexpr Duration settle = std::chrono::seconds{1};
    // Number of stamps that are read in a second. If there are more files, each is polled less
    // often.
    static constexpr std::size_t most_looks = 512;
    static constexpr std::size_t most_looks_at_once = 64;
    // A file whose writer keeps it open and writes often never settles, but its sweeps must be
    // shown soon. As a side effect, a large file that is being copied is ingested once in vain.
    static constexpr Duration busy = std::chrono::seconds{3};
    // A followed file is finished after this many times `quiet`. Its sweeps are shown before that.
    // To finish it too early is expensive: if more data come, the whole file must be read again.
    static constexpr int patience = 10;

    GrowingFiles(Duration quiet, std::size_t limit) : quiet_(quiet), limit_(limit) {}

    void set_quiet(Duration quiet) { quiet_ = quiet; }
    // Adds a new file, unless it is known already. Returns false if there is no room. `station` is
    // empty for every unknown station, so all of these count as one station.
    bool add_new(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                 const std::string& station = {});
    // Adds an incomplete file. Replaces what is known about its path. Returns false if there is no
    // room. `stamp` is from before the file was read, or FileStamp{} if the file is gone. Polls
    // return a gone file, too, because chunks of its volume wait under its name.
    bool add_incomplete(const std::filesystem::path& path, const FileStamp& stamp, SteadyTime now,
                        bool followed = false, const std::string& station = {});
    void forget(const std::filesystem::path& path);
    // Returns the files that lost their places to other files since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }

    struct Due {
        std::filesystem::path path;
        FileStamp stamp;
        bool finish_as_is = false;
    };
    // If a poll is due, reads stamps, and returns and forgets the files that must be ingested. Also
    // forgets a file that has vanished or become something else. If such a file was incomplete,
    // returns it as well, because chunks of its volume may wait for it.
    using Look = std::function<FileFound(const std::filesystem::path&)>;
    std::vector<Due> poll(SteadyTime now, const Look& look);

    // Returns the incomplete files that do not change, each with the time until its volume is
    // finished without its end. Returns at most `most` files, the soonest first.
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
    // Returns when the file was last ingested and found incomplete; none if it is not among the
    // incomplete files here.
    [[nodiscard]] std::optional<SteadyTime> found_incomplete_at(
        const std::filesystem::path& path) const;

  private:
    struct File {
        FileStamp looked_at;  // of an incomplete file: its stamp when it was read
        FileStamp last;
        SteadyTime since;       // when the file was added
        SteadyTime changed_at;  // when `last` was first seen
        bool incomplete = false;
        bool followed = false;
        std::string station = {};
    };
    // The keys are paths as text, because comparing std::filesystem::path takes ten times as long.
    using Files = std::map<std::string, File>;
    bool has_room_for(const std::string& station);
    void add(const std::filesystem::path& path, File file, SteadyTime now);
    // Polls one file and returns the next entry.
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
    std::size_t looks_left_ = 0;  // of the current round of polls
    SteadyTime next_round_{};
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon
