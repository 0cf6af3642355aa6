// synth/replay.h -- writes files into a drop directory as LDM would.
//
// Files are written in one of four ways:
//   whole    Each file is written under a dot-name and then renamed, as by a script that runs at
//            the last chunk of a volume.
//   growing  Again and again, a file is opened, one piece is appended, and the file is closed, as
//            by pqact's `FILE -close`.
//   open     A file is opened, and pieces are appended without closing it, as by pqact's `FILE`. It
//            stays open until `most_open_files` other files have been written after it, or to the
//            end.
//   chunks   Each piece is a file, DROP/KTLX/494/20220317-000842-001-S, as by pqact's `FILE -close`
//            with the number of the chunk in the name. It is written under this name from the
//            beginning, and closed, as by pqact. Station and time come from the header (or from the
//            file name, if the header has no station). The volume's number comes from the header;
//            if an earlier volume has that number, the next free number is used. The first chunk is
//            S. The last is E if its control word is negative, as at the end of a volume. All other
//            chunks are I.
// synth/replay_pieces.h defines the pieces, and synth/replay_faults.h the faults. Gzipped files are
// unpacked only for chunks.
//
// The first piece of a file comes at the time in its header. The other pieces come at equal
// intervals until the same station's next volume begins, but within `longest_volume_s`. The last
// volume of a station takes as long as the station's previous volume; the only volume of a station
// takes `usual_volume_s`. So volumes of several stations overlap, as in a feed. Whole files come at
// the time in their header. Files without a readable header come last, in the order of their names,
// without waits.
//
// Sources are only read. Files that are already in the drop directory are never overwritten.
//
// Memory    Holds all files that are growing at the same time.
// Threads   One thread at a time; another thread may set `stop`.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "synth/replay_faults.h"

namespace stormcellar::synth {

inline constexpr double longest_volume_s = 600, usual_volume_s = 300;
inline constexpr std::size_t most_open_files = 32;

struct ReplayItem {
    std::filesystem::path source;
    std::filesystem::path name;      // below the drop directory
    std::optional<UtcTime> time;     // from the header of the volume
    std::string station;             // from the header or the file's name; empty: unknown
    std::optional<int> number = {};  // of the volume, from its header
    bool has_records = false;        // LDM records, maybe inside gzip
};

// Finds the files to play, in the order of replay. A file keeps its name. If a name is an archive
// (tar, zip), its members are played, and keep their names. If a name is a directory, all regular
// files in it are played, with their relative names. Dot-files are left out, because they may still
// be written. Errors: not_found if there is nothing at all; bad_argument if two files would get the
// same name.
[[nodiscard]] Result<std::vector<ReplayItem>> find_replay_items(
    const std::vector<std::filesystem::path>& sources);

// Returns the reason why a file cannot be played in chunks; empty if it can.
[[nodiscard]] std::string_view why_not_in_chunks(const ReplayItem& item);

enum class Delivery : std::uint8_t { whole, growing, open, chunks };

struct ReplayOptions {
    Delivery delivery = Delivery::whole;
    // Seconds from one file to the next. If empty, files come at the times in their headers, sped
    // up by `speed`.
    std::optional<double> interval_s;
    double speed = 1;
    FaultRates faults;
    // Ends the replay before the next piece when it is set.
    const std::atomic<bool>* stop = nullptr;
    std::function<void(std::size_t done)> replayed;  // called after each file
    // Called after each file, with its item.
    std::function<void(const ReplayItem& item)> ended;
    // Called with the bytes of a file before the bytes are written. The function may change the
    // bytes, but not where the pieces end.
    std::function<void(const ReplayItem& item, std::span<std::byte> bytes)> stamp;
    // Pieces that are due in the first `past_s` seconds are written at once, as if the replay had
    // begun that long ago. Then `begun` is called, and the clock continues from `past_s`.
    double past_s = 0;
    std::function<void()> begun;
    // Called before each wait of more than `long_wait_s`, with the length of the wait and the
    // source of the next file.
    std::function<void(double seconds, const std::filesystem::path& source)> waits;
};

inline constexpr double long_wait_s = 10;

// The plan of a replay.
struct ReplayPlan {
    std::size_t files = 0;
    std::optional<UtcTime> first, last;  // times of the files; none if no file has a time
    double takes_s = 0;                  // without the time for writing
};
[[nodiscard]] ReplayPlan plan_replay(const std::vector<ReplayItem>& items,
                                     const ReplayOptions& options);

// A fault that was made on purpose.
struct FaultMade {
    Fault fault = Fault::none;
    std::filesystem::path source;
    // the file's name, or that of the chunk's own file, below the drop directory
    std::filesystem::path name;
    std::size_t chunk = 0;         // from 1, within the source; 0: the fault affects the whole file
    std::uint64_t bytes = 0;       // size of the element
    std::uint64_t kept_bytes = 0;  // bytes that were written: fewer if truncated, 0 if dropped
};

struct ReplayReport {
    std::size_t files = 0;    // files that are finished
    std::size_t writes = 0;   // pieces or whole files written
    std::uint64_t bytes = 0;  // written
    bool stopped = false;
    std::vector<std::filesystem::path> unfinished;  // still growing when the replay stopped
    std::vector<FaultMade> faults;                  // in the order in which they were made
};

// Plays the items. Errors before anything is written: io if the target of an item exists;
// bad_argument for chunks of a file that has no LDM records, or an unknown time or station. Later
// errors are those of reading or writing, and leave the files that were written before.
[[nodiscard]] Result<ReplayReport> replay(const std::vector<ReplayItem>& items,
                                          const std::filesystem::path& drop,
                                          FileSystem& file_system, const ReplayOptions& options);

}  // namespace stormcellar::synth
