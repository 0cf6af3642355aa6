// synth/replay.h -- plays files into a drop directory as LDM would.
//
//   whole     each file under a dot-name, then renamed: what a script does at a volume's last chunk
//   growing   each file opened, one piece appended and closed, again and again: pqact's
//             `FILE -close`
//   open      the same without the closing, pqact's `FILE`: each file stays open until
//             `most_open_files` others were written later, or to the end
//   chunks    one file a piece, DROP/KTLX/494/20220317-000842-001-S: pqact's `FILE -close` with the
//             chunk's number in the name. Written in place and closed, as pqact does, under no
//             other name before. By the header's station and time (the file name's where a header
//             has no station); the number is the header's, or where that was had by an earlier
//             volume the next free one. The first is S; the last is E where its control word is
//             negative, as it is at a volume's end; all others are I.
// Pieces: synth/replay_pieces.h. Files that are gzipped are unpacked for chunks, for nothing else.
// Times: a file's first piece comes at the time in its header; the others are spread evenly until
// the same station's next volume begins, at most `longest_volume_s`; the last of a station takes as
// long as the one before it, an only one `usual_volume_s`. So those of several stations mix, as
// they do in a feed. What is whole comes at the time in its header. Files without a readable
// header come last, at once, by name.
// Faults: synth/replay_faults.h.
// Sources are only read. Nothing that was in the drop directory is ever written over.
// Memory: the files that are growing at the same time.
// Threads: one; `stop` may be set by another.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
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
    std::string station;             // from there or the file's name; empty: unknown
    std::optional<int> number = {};  // of the volume, from its header
    bool has_records = false;        // LDM records, maybe in gzip
};

// Files are taken under their own names, archives (tar, zip) with their members under theirs,
// directories with all regular files in them under their relative ones (dot-files are left out:
// they are still being written). In the order of replay. not_found when there is nothing at all,
// bad_argument when two would get the same name.
[[nodiscard]] Result<std::vector<ReplayItem>> find_replay_items(
    const std::vector<std::filesystem::path>& sources);

// Why a file cannot be played in chunks; empty where it can.
[[nodiscard]] std::string_view why_not_in_chunks(const ReplayItem& item);

enum class Delivery : std::uint8_t { whole, growing, open, chunks };

struct ReplayOptions {
    Delivery delivery = Delivery::whole;
    // Seconds from one file to the next, one after the other; without it by the times above,
    // divided by `speed`.
    std::optional<double> interval_s;
    double speed = 1;
    FaultRates faults;
    const std::atomic<bool>* stop = nullptr;  // when set, the replay ends, between two pieces
    std::function<void(std::size_t done)> replayed;  // after each file
    // Before each wait of more than `long_wait_s`: how long, and for the file of which source.
    std::function<void(double seconds, const std::filesystem::path& source)> waits;
};

inline constexpr double long_wait_s = 10;

// What a replay is going to do.
struct ReplayPlan {
    std::size_t files = 0;
    std::optional<UtcTime> first, last;  // of the files' times; none where no file has one
    double takes_s = 0;                  // but for the time that the work takes
};
[[nodiscard]] ReplayPlan plan_replay(const std::vector<ReplayItem>& items,
                                     const ReplayOptions& options);

// What was done wrong on purpose.
struct FaultMade {
    Fault fault = Fault::none;
    std::filesystem::path source;
    std::filesystem::path name;    // below the drop directory: of the file, or of the chunk's own
    std::size_t chunk = 0;         // from 1 within the source; 0: the whole file
    std::uint64_t bytes = 0;       // that it has
    std::uint64_t kept_bytes = 0;  // that were written of it: fewer when truncated, none if dropped
};

struct ReplayReport {
    std::size_t files = 0;    // whose turn is over
    std::size_t writes = 0;   // of pieces, or of whole files
    std::uint64_t bytes = 0;  // written
    bool stopped = false;
    std::vector<std::filesystem::path> unfinished;  // that were growing when it was stopped
    std::vector<FaultMade> faults;                  // in the order in which they were made
};

// Errors, before anything is written: io when a file of that name is there; bad_argument for chunks
// of a file that holds no LDM records, or of which time or station are unknown. Later what reading
// or writing gives, after which what was written before it stays.
[[nodiscard]] Result<ReplayReport> replay(const std::vector<ReplayItem>& items,
                                          const std::filesystem::path& drop,
                                          FileSystem& file_system, const ReplayOptions& options);

}  // namespace stormcellar::synth
