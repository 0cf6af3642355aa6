// synth/replay.h -- plays files into a drop directory as LDM would.
//
// There are four ways of writing:
//   whole    Each file is written under a dot-name and then renamed, as a script does at the last
//            chunk of a volume.
//   growing  Each file is opened, one piece is appended, and the file is closed, again and again,
//            like pqact's `FILE -close`.
//   open     Each file is opened, and pieces are appended without closing it, like pqact's `FILE`.
//            A file stays open until `most_open_files` others were written after it, or to the end.
//   chunks   There is one file for each piece, DROP/KTLX/494/20220317-000842-001-S, like pqact's
//            `FILE -close` with the number of the chunk in the name. It is written in place and
//            closed, as by pqact, never under another name first. Station and time come from the
//            header (or from the file name, if the header has no station). The volume's number
//            comes from the header, or is the next free one if an earlier volume has it. The first
//            chunk is S. The last is E if its control word is negative, as at the end of a volume.
//            All others are I.
// synth/replay_pieces.h defines the pieces, synth/replay_faults.h the faults. Gzipped files are
// unpacked for chunks only.
//
// The first piece of a file comes at the time in its header. Its other pieces are spread evenly
// until the same station's next volume begins, over at most `longest_volume_s`. The last volume of
// a station takes as long as the station's volume before it, and the only volume of a station takes
// `usual_volume_s`. So volumes of several stations overlap, as in a feed. Whole files come at the
// time in their header. Files without a readable header come last, in order of their names, without
// a wait.
//
// Sources are only read. Files that were already in the drop directory are never overwritten.
//
// Memory    Holds the files that are growing at the same time.
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

// Finds the files to play, in the order of replay. Files keep their own names. Archives (tar, zip)
// give their members under their names. Directories give all regular files in them under their
// relative names, but no dot-files, which may still be written. Errors: not_found if there is
// nothing at all; bad_argument if two files would get the same name.
[[nodiscard]] Result<std::vector<ReplayItem>> find_replay_items(
    const std::vector<std::filesystem::path>& sources);

// Returns why a file cannot be played in chunks; empty if it can.
[[nodiscard]] std::string_view why_not_in_chunks(const ReplayItem& item);

enum class Delivery : std::uint8_t { whole, growing, open, chunks };

struct ReplayOptions {
    Delivery delivery = Delivery::whole;
    // Seconds from one file to the next. If empty, files come at the times in their headers,
    // divided by `speed`.
    std::optional<double> interval_s;
    double speed = 1;
    FaultRates faults;
    const std::atomic<bool>* stop = nullptr;         // when set, the replay ends between two pieces
    std::function<void(std::size_t done)> replayed;  // called after each file
    // Called after each file, with its item.
    std::function<void(const ReplayItem& item)> ended;
    // Called with a file's bytes before they are written. It may change the bytes, but not the ends
    // of the pieces.
    std::function<void(const ReplayItem& item, std::span<std::byte> bytes)> stamp;
    // Pieces that are due in the first `past_s` seconds are written at once, as if the replay had
    // begun that long ago. Then `begun` is called, and the clock continues from `past_s`.
    double past_s = 0;
    std::function<void()> begun;
    // Called before each wait of more than `long_wait_s`, with its length and the source of the
    // next file.
    std::function<void(double seconds, const std::filesystem::path& source)> waits;
};

inline constexpr double long_wait_s = 10;

// The plan of a replay.
struct ReplayPlan {
    std::size_t files = 0;
    std::optional<UtcTime> first, last;  // times of the files; none if no file has one
    double takes_s = 0;                  // without the time for writing
};
[[nodiscard]] ReplayPlan plan_replay(const std::vector<ReplayItem>& items,
                                     const ReplayOptions& options);

// A fault that was made on purpose.
struct FaultMade {
    Fault fault = Fault::none;
    std::filesystem::path source;
    // of the file, or of the chunk's own file, below the drop directory
    std::filesystem::path name;
    std::size_t chunk = 0;         // from 1, within the source; 0: the whole file
    std::uint64_t bytes = 0;       // its size
    std::uint64_t kept_bytes = 0;  // written bytes: fewer if truncated, 0 if dropped
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
// bad_argument for chunks of a file that holds no LDM records, or whose time or station are
// unknown. Later errors are those of reading or writing; files written before stay.
[[nodiscard]] Result<ReplayReport> replay(const std::vector<ReplayItem>& items,
                                          const std::filesystem::path& drop,
                                          FileSystem& file_system, const ReplayOptions& options);

}  // namespace stormcellar::synth
