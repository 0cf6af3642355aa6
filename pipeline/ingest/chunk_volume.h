// pipeline/ingest/chunk_volume.h -- a volume that comes as one file for each chunk.
//
// Decoded sweeps are kept on disk, on a shelf (pipeline/keep/sweep_shelf.h), until they are needed.
// Inside the pipeline room only. Thread contract: one thread at a time, which holds the lock of the
// Guarded that holds the volume (pipeline/ingest/chunk_volumes.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/growing_set.h"
#include "stormcellar/level2/live_volume.h"

namespace stormcellar::pipeline {

class ChunkVolume {
  public:
    ChunkVolume(const FollowedFile::Options& options, const level2::LiveOptions& live);

    enum class Added : std::uint8_t {
        added,       // the volume has the chunk, from this call or an earlier one
        unfinished,  // the file holds no complete chunk yet
        not_ours,    // despite its name, no chunk of this volume: ingest it as another kind
    };
    // Adds the chunk. Does not read its file if it was read before with the same stamp. Errors: io
    // or no_space if the file cannot be read now, for example because descriptors or memory ran
    // out; poll it again then.
    [[nodiscard]] Result<Added> add(const ChunkPath& chunk, const FileStamp& stamp);
    // Adds the chunk. Until one call has succeeded, also adds the other chunks in the same
    // directory, up to the limits of one job. Errors: those of add() for any of these chunks. If
    // reading the other chunks has failed for two minutes, the volume continues without the chunks
    // that cannot be read.
    [[nodiscard]] Result<Added> add_with_siblings(const ChunkPath& chunk, const FileStamp& stamp);

    // If numbers are missing, adds the chunks of the volume that have come in the meantime, because
    // their own jobs may have to wait. Looks for such chunks at most once a second, but at once if
    // `of` is the end of the volume.
    void add_what_is_missing(const ChunkPath& of);

    // Returns true if the volume has a representative that held a complete chunk when it was last
    // read. The representative is the one file that is polled for the volume while nothing comes.
    // It is the chunk that was added last, unless set_representative() named another file.
    [[nodiscard]] bool has_representative() const;
    // Returns true if this file is the representative and held a complete chunk when it was last
    // read.
    [[nodiscard]] bool is_representative(const std::filesystem::path& path) const;
    void set_representative(const std::filesystem::path& path) { representative_ = path; }
    // Returns the file that was the representative before the last chunk was added. Returns an
    // empty path if there was none, or if an earlier call has returned it.
    [[nodiscard]] std::filesystem::path take_former_representative() {
        return std::exchange(former_representative_, {});
    }

    // Closes the volume to further chunks. A caller that finds a closed volume must ask
    // ChunkVolumes for a new one.
    void close() { is_closed_ = true; }
    [[nodiscard]] bool is_closed() const { return is_closed_; }

    [[nodiscard]] bool is_whole() const { return live_.is_whole(); }
    [[nodiscard]] bool is_due() const { return live_.is_due(level2::LiveVolume::Clock::now()); }
    [[nodiscard]] std::vector<int> missing_numbers() const { return live_.missing_numbers(); }
    [[nodiscard]] UnshownSweeps news() const { return news_; }
    void set_shown() { news_ = {}; }
    // Returns the sweeps on the shelf; null if there was no room for a shelf.
    [[nodiscard]] const ShelvedVolume* kept() const { return kept_.get(); }
    // Returns true if some sweeps are complete and on the shelf.
    [[nodiscard]] bool has_sweeps() const { return kept_ && !kept_->places.empty(); }
    // Describes the growing volume for the catalog: its start and its complete sweeps. Returns none
    // while chunk 1 is missing or no sweep is complete.
    [[nodiscard]] std::optional<catalog::VolumeFacts> living_facts() const;
    // Returns the approximate size of the volume in memory and on the shelf.
    [[nodiscard]] Growth growth() const {
        return {live_.held_bytes(), kept_ ? kept_->shelf->bytes() : 0, has_sweeps()};
    }

    struct File {
        FileStamp stamp;
        std::uint64_t content_hash = 0;
        int number = 0;
        bool is_whole = true;
    };
    [[nodiscard]] const std::map<std::filesystem::path, File>& files() const { return files_; }
    // Returns the path of the complete chunk with the lowest number. The volume must have such a
    // chunk.
    [[nodiscard]] std::filesystem::path first_file() const;
    [[nodiscard]] std::string station() const { return live_.facts().station; }

    [[nodiscard]] Result<level2::Decoded> finish();
    // Keeps the VELD of `dealiased`, the complete volume that finish() returned, with the sweeps.
    void keep_dealiased(const level2::Volume& dealiased);
    [[nodiscard]] std::shared_ptr<const ShelvedVolume> take_kept() { return std::move(kept_); }

  private:
    // The counters at the start of a job. From these, is_enough() tells whether the job has read
    // enough.
    struct InOneJob {
        std::uint64_t read_bytes = 0;
        std::size_t refused = 0;
        [[nodiscard]] bool is_enough(const ChunkVolume& volume) const;
    };
    Status add_siblings(const ChunkPath& of);
    Result<Added> read_and_add(const ChunkPath& chunk, const FileStamp& stamp);
    [[nodiscard]] level2::LiveOptions with_depot(level2::LiveOptions live) const;
    void shelve(const level2::Sweep& sweep);
    void shelve_new_sweeps();

    bool is_loaded_ = false;  // add_with_siblings() has added the chunks in the directory
    bool is_closed_ = false;
    std::vector<level2::Moment> moments_;
    std::filesystem::path beneath_;
    std::unique_ptr<ShelvedVolume> kept_;
    std::unique_ptr<level2::SweepDepot> depot_;  // puts sweeps on the shelf of kept_
    level2::LiveVolume live_;
    std::map<std::filesystem::path, File> files_;
    std::uint64_t read_bytes_ = 0;
    // The number of radials of each complete sweep, by cut; and the time of the newest of these
    // sweeps.
    std::map<std::size_t, std::size_t> radial_counts_;
    std::optional<UtcTime> newest_radial_;
    // Files that were read and are not chunks of this volume, with their stamps.
    std::map<std::filesystem::path, FileStamp> refused_;
    std::filesystem::path representative_, former_representative_;
    UnshownSweeps news_;
    std::optional<level2::LiveVolume::Clock::time_point> fails_since_;
    level2::LiveVolume::Clock::time_point next_catching_up_{};
};

// Returns when the file came, by the clock of LiveVolume. If a volume is joined again, after a
// restart or after it was given up, its waiting time therefore still counts from the arrival of its
// files.
[[nodiscard]] level2::LiveVolume::Clock::time_point arrival_of(const FileStamp& stamp);

}  // namespace stormcellar::pipeline
