// synth/replay.h -- plays files into a drop directory as LDM would.
//
//   whole     each file under a dot-name, then renamed: what a script does at a volume's last chunk
//   growing   each file opened, one piece appended and closed, again and again: pqact's
//             `FILE -close`. A piece is an LDM record (the first with the header before it); what
//             has no LDM records comes in sixteenths.
// Files come one after the other, in the order of the times in their headers; those without a
// readable header come last, by name. Sources are only read. Nothing in the drop directory is ever
// written over.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/file_system.h"
#include "base/result.h"
#include "base/utc_time.h"

namespace stormcellar::synth {

struct ReplayItem {
    std::filesystem::path source;
    std::filesystem::path name;   // below the drop directory
    std::optional<UtcTime> time;  // from the header of the volume
};

// Files are taken under their own names, directories with all regular files in them under their
// relative ones (dot-files are left out: they are still being written). In the order of replay.
// not_found when there is nothing at all, bad_argument when two would get the same name.
[[nodiscard]] Result<std::vector<ReplayItem>> find_replay_items(
    const std::vector<std::filesystem::path>& sources);

enum class Delivery : std::uint8_t { whole, growing };

struct ReplayOptions {
    Delivery delivery = Delivery::whole;
    // Seconds from one file to the next; without it the difference of their times, divided by
    // `speed` (none where a time is unknown). A growing file's pieces are spread over it.
    std::optional<double> interval_s;
    double speed = 1;
    const std::atomic<bool>* stop = nullptr;  // when set, the replay ends, between two pieces
    std::function<void(std::size_t done)> replayed;  // after each file
};

struct ReplayReport {
    std::size_t files = 0;  // that are whole in the drop directory
    std::uint64_t bytes = 0;
    bool stopped = false;
    std::filesystem::path unfinished;  // the file that was growing when it was stopped, if any
};

// Errors: io, before anything is written, when a file of that name is there; later what reading or
// writing gives, after which the files before it stay.
[[nodiscard]] Result<ReplayReport> replay(const std::vector<ReplayItem>& items,
                                          const std::filesystem::path& drop,
                                          FileSystem& file_system, const ReplayOptions& options);

// Where the pieces of a growing file end, rising; the last is its size.
[[nodiscard]] std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes);

}  // namespace stormcellar::synth
