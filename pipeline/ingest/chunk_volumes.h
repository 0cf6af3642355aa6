// pipeline/ingest/chunk_volumes.h -- volumes that come as one file a chunk.
//
// The chunks of one volume are the files of a directory whose names differ only in the chunk's
// number and kind (stormcellar/level2/chunk_name.h). Whichever chunk comes first, all that are in
// its directory are read, so nothing depends on what was seen before: after a restart, and when a
// late chunk comes, the volume is joined again from its files. The set is bounded for each station
// and in all (pipeline/ingest/followed.h). A volume that was given up, or found no place, is read
// from its files when no more chunks come. Inside the pipeline room only. Thread contract: many
// threads may call all functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/ingest/chunk_volume.h"
#include "pipeline/ingest/followed.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/guarded.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {

class ChunkVolumes {
  public:
    explicit ChunkVolumes(FollowedFile::Options options, GrowingLimits limits = {})
        : options_(std::move(options)), volumes_(limits) {}

    using Shared = std::shared_ptr<Guarded<ChunkVolume>>;
    // Chunks that the caller still expects of a volume.
    enum class Expected : std::uint8_t { more, its_end_is_there, nothing };
    // Finds the volume, or makes it. `station` is the station that its path names. Returns null if
    // there is no place for the volume and more of it is expected, or if it was given up and has
    // not ended; then poll again when no more chunks come. A volume that was given up is read once
    // more when its end comes; if that does not complete it, it waits like the others.
    [[nodiscard]] Shared find(const ChunkPath& chunk, const std::string& station,
                              Expected expected = Expected::more);
    // Returns true if the names and times of its files, without their contents, allow to finish the
    // volume: its end is there, or nothing has come for the timeout.
    [[nodiscard]] bool may_be_due(const ChunkPath& chunk) const;
    // For a volume that found no place: this chunk now represents it, instead of the chunk that is
    // given (empty: none).
    [[nodiscard]] std::filesystem::path poll_for_place(const ChunkPath& chunk);
    // Null if the volume is not known.
    [[nodiscard]] Shared find_known(const ChunkPath& chunk) const;
    // Counts what the volume holds now. Returns false if that exceeds its share; then the volume
    // was given up.
    [[nodiscard]] bool grew(const ChunkPath& chunk, const Shared& volume, const Growth& growth,
                            const std::string& station);
    void forget(const ChunkPath& chunk);
    void forget(const ChunkPath& chunk, const Shared& volume);  // if it is still this volume
    [[nodiscard]] std::size_t count() const;
    // Returns the number of volumes that were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up();

  private:
    void forget_key(const std::string& key) STORMCELLAR_REQUIRES(mutex_);

    FollowedFile::Options options_;
    mutable Mutex mutex_;
    Followed<std::string, Guarded<ChunkVolume>> volumes_ STORMCELLAR_GUARDED_BY(mutex_);
    // Chunks that represent volumes without a place.
    std::map<std::string, std::filesystem::path> representatives_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
