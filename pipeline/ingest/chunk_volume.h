// pipeline/ingest/chunk_volume.h -- one volume that comes as one file a chunk.
//
// What is decoded lies on the shelf (pipeline/keep/sweep_shelf.h) until it is wanted.
// Inside the pipeline room only. Thread contract: one thread at a time, which the lock of its
// Guarded sees to (pipeline/ingest/chunk_volumes.h).
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
        added,       // or was there
        unfinished,  // nothing in it is whole yet
        not_ours,    // no chunk of this volume, whatever its name says: to be taken by itself
    };
    // Reads the file unless it is known with this stamp. io, no_space: it cannot be read now, as
    // when descriptors or memory run out, and is to be asked for again.
    [[nodiscard]] Result<Added> add(const ChunkPath& chunk, const FileStamp& stamp);
    // The same, and with the first chunk all others that lie beside it. Errors as add(): some may
    // be missing; for two minutes, then the volume goes without them.
    [[nodiscard]] Result<Added> add_with_siblings(const ChunkPath& chunk, const FileStamp& stamp);

    // Where numbers are missing, those that lie beside this one, which came later: their own jobs
    // may wait behind others for long. At most once a second.
    void add_what_is_missing(const ChunkPath& of);

    // The representative is the one file that is polled on behalf of the volume when nothing has
    // come for a while. It is the chunk that was added last, unless set_representative() names
    // another. Returns false if its file no longer holds a whole chunk; then another must replace
    // it.
    [[nodiscard]] bool has_representative() const;
    // Returns true if this file is the representative and held a whole chunk when it was read.
    [[nodiscard]] bool is_representative(const std::filesystem::path& path) const;
    void set_representative(const std::filesystem::path& path) { representative_ = path; }
    // Returns the representative of before the last chunk was added; empty if there was none, and
    // at the second call.
    [[nodiscard]] std::filesystem::path take_former_representative() {
        return std::exchange(former_representative_, {});
    }

    // Nothing more is added to a closed volume. Whoever meets one asks for a new one in its place.
    void close() { is_closed_ = true; }
    [[nodiscard]] bool is_closed() const { return is_closed_; }

    [[nodiscard]] bool is_whole() const { return live_.is_whole(); }
    [[nodiscard]] bool is_due() const { return live_.is_due(level2::LiveVolume::Clock::now()); }
    [[nodiscard]] std::vector<int> missing_numbers() const { return live_.missing_numbers(); }
    [[nodiscard]] UnshownSweeps news() const { return news_; }
    void set_shown() { news_ = {}; }
    // Null where there is no room on the shelf.
    [[nodiscard]] const ShelvedVolume* kept() const { return kept_.get(); }
    // Some of its sweeps have closed.
    [[nodiscard]] bool has_sweeps() const { return kept_ && !kept_->places.empty(); }
    // What it holds in memory, about, and on the shelf.
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
    // Of the lowest number that is whole; there must be one.
    [[nodiscard]] std::filesystem::path first_file() const;
    [[nodiscard]] std::string station() const { return live_.facts().station; }

    [[nodiscard]] Result<level2::Decoded> finish();
    [[nodiscard]] std::shared_ptr<const ShelvedVolume> take_kept() { return std::move(kept_); }

  private:
    // What had been read when a job began.
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

    bool is_loaded_ = false;  // what lies beside the first chunk was added
    bool is_closed_ = false;
    level2::Moment moment_;
    std::filesystem::path beneath_;
    std::unique_ptr<ShelvedVolume> kept_;
    std::unique_ptr<level2::SweepDepot> depot_;  // on the shelf of kept_
    level2::LiveVolume live_;
    std::map<std::filesystem::path, File> files_;
    std::uint64_t read_bytes_ = 0;
    // What was read and is no chunk of this volume, as it was then.
    std::map<std::filesystem::path, FileStamp> refused_;
    std::filesystem::path representative_, former_representative_;
    UnshownSweeps news_;
    std::optional<level2::LiveVolume::Clock::time_point> fails_since_;
    level2::LiveVolume::Clock::time_point next_catching_up_{};
};

// When the file came, by the clock of LiveVolume. A volume that is put together again after a
// restart, or after it was given up for others, has waited since its files came.
[[nodiscard]] level2::LiveVolume::Clock::time_point arrival_of(const FileStamp& stamp);

}  // namespace stormcellar::pipeline
