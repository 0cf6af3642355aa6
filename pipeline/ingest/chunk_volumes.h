// pipeline/ingest/chunk_volumes.h -- volumes that come as one file a chunk.
//
// Chunks of one volume are the files of a directory whose names differ in the chunk's number and
// kind alone (stormcellar/level2/chunk_name.h). Whichever of them is met first, all that lie there
// are read, so that nothing depends on what was seen before: after a restart, and when a late chunk
// comes, the volume is put together again from the files. What is decoded lies on the shelf
// (pipeline/keep/sweep_shelf.h) until it is wanted. Bounded for each station and in all
// (pipeline/ingest/followed.h). A volume that was given up, and one that found no place, is read
// from its files when nothing more comes of it. Inside the pipeline room only. Thread contract: of
// ChunkVolumes, all may be called by many threads; of ChunkVolume, one thread at a time, which the
// lock of its Guarded sees to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/followed.h"
#include "pipeline/ingest/guarded.h"
#include "pipeline/ingest/living_file.h"
#include "pipeline/options/ingest_options.h"
#include "stormcellar/level2/live_volume.h"

namespace stormcellar::pipeline {

class ChunkVolume {
  public:
    ChunkVolume(const LivingFile::Options& options, const level2::LiveOptions& live);

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

    // One file is offered again, on behalf of all, when nothing has come for a while: the waiter.
    // That is the chunk that was added last, until it is named otherwise.
    // False when the waiter's file holds no whole chunk (any more): another must take its place.
    [[nodiscard]] bool has_waiter() const;
    // Whether this file is the waiter, and holds a whole chunk, whatever has become of it since.
    [[nodiscard]] bool is_waiter(const std::filesystem::path& path) const;
    void set_waiter(const std::filesystem::path& path) { waiter_ = path; }
    // The file that was the waiter before the last chunk was added, once; empty: none.
    [[nodiscard]] std::filesystem::path take_former_waiter() {
        return std::exchange(former_waiter_, {});
    }

    // Nothing more is added to a closed volume. Whoever meets one asks for a new one in its place.
    void close() { is_closed_ = true; }
    [[nodiscard]] bool is_closed() const { return is_closed_; }

    [[nodiscard]] bool is_whole() const { return live_.is_whole(); }
    [[nodiscard]] bool is_due() const { return live_.is_due(level2::LiveVolume::Clock::now()); }
    [[nodiscard]] std::vector<int> missing_numbers() const { return live_.missing_numbers(); }
    [[nodiscard]] LivingNews news() const { return news_; }
    void set_shown() { news_ = {}; }
    // Null where there is no room on the shelf.
    [[nodiscard]] const KeptVolume* kept() const { return kept_.get(); }
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
    [[nodiscard]] std::shared_ptr<const KeptVolume> take_kept() { return std::move(kept_); }

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
    std::unique_ptr<KeptVolume> kept_;
    std::unique_ptr<level2::SweepDepot> depot_;  // on the shelf of kept_
    level2::LiveVolume live_;
    std::map<std::filesystem::path, File> files_;
    std::uint64_t read_bytes_ = 0;
    // What was read and is no chunk of this volume, as it was then.
    std::map<std::filesystem::path, FileStamp> refused_;
    std::filesystem::path waiter_, former_waiter_;
    LivingNews news_;
    std::optional<level2::LiveVolume::Clock::time_point> fails_since_;
    level2::LiveVolume::Clock::time_point next_catching_up_{};
};

class ChunkVolumes {
  public:
    explicit ChunkVolumes(LivingFile::Options options, GrowingLimits limits = {})
        : options_(std::move(options)), volumes_(limits) {}

    using Shared = std::shared_ptr<Guarded<ChunkVolume>>;
    // What is still to come of a volume, as far as its caller knows.
    enum class Expected : std::uint8_t { more, its_end_is_there, nothing };
    // Made where it is not known. `station`: whose its path says that it is. Null where there is no
    // place for it and more is expected, or where it was given up and is not over: it is to be
    // asked for again when it is quiet. One that was given up is read once more when its end comes:
    // should that not make it whole, it waits like the others.
    [[nodiscard]] Shared find(const ChunkPath& chunk, const std::string& station,
                              Expected expected = Expected::more);
    // Whether a volume may be finished by what its files' names and times say, without reading
    // them: its end is there, or nothing has come for the timeout.
    [[nodiscard]] bool may_be_due(const ChunkPath& chunk) const;
    // Of a volume that found no place: this chunk waits for it now, in the place of the one that is
    // given (empty: none).
    [[nodiscard]] std::filesystem::path wait_for_place(const ChunkPath& chunk);
    // Null where it is not.
    [[nodiscard]] Shared find_known(const ChunkPath& chunk) const;
    // Counts what it takes now. False: that is more than its share, and it was given up.
    [[nodiscard]] bool grew(const ChunkPath& chunk, const Shared& volume, const Growth& growth,
                            const std::string& station);
    void forget(const ChunkPath& chunk);
    void forget(const ChunkPath& chunk, const Shared& volume);  // if it is still this one
    [[nodiscard]] std::size_t count() const;
    // How many were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up();

  private:
    void forget_key(const std::string& key);

    LivingFile::Options options_;
    mutable std::mutex mutex_;  // guards what follows
    Followed<std::string, Guarded<ChunkVolume>> volumes_;
    std::map<std::string, std::filesystem::path> waiters_;  // of those that found no place
};

}  // namespace stormcellar::pipeline
