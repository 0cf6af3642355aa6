// pipeline/ingest/chunk_volumes.h -- the volumes that come in chunks, one file for each chunk.
//
// The chunks of one volume are the files of a directory whose names differ only in the number and
// the kind of the chunk (stormcellar/level2/chunk_name.h). When the first chunk of a volume comes,
// whatever its number is, all chunks in the directory are read. So the volume can be joined again
// from its files after a restart, and when a late chunk comes. The number and size of volumes are
// limited for each station and in total (pipeline/ingest/followed.h). A volume that was given up,
// or that found no place, is read from its files when no more chunks come. Inside the pipeline room
// only. Thread contract: many threads may call all functions.
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
    // The part of a volume that the caller still expects after a chunk.
    enum class Expected : std::uint8_t { more, its_end_is_there, nothing };
    // Returns the volume; makes it if it is unknown. `station` is the station in its path. If more
    // chunks are expected, returns null if there is no place for the volume or it was given up; the
    // caller polls again when no more chunks come. A volume that was given up gets one more try
    // when its end comes; after that, null is returned until nothing is expected.
    [[nodiscard]] Shared find(const ChunkPath& chunk, const std::string& station,
                              Expected expected = Expected::more);
    // Returns true if the volume may be finished: its end has come, or nothing has come for the
    // timeout. Judges by the names and times of its files, and reads no contents.
    [[nodiscard]] bool may_be_due(const ChunkPath& chunk) const;
    // Makes this chunk the representative of a volume that found no place. Returns the chunk that
    // was the representative before; returns an empty path if this chunk was already the
    // representative, or if there was none.
    [[nodiscard]] std::filesystem::path poll_for_place(const ChunkPath& chunk);
    // Returns the volume of this chunk, or null if it is unknown.
    [[nodiscard]] Shared find_known(const ChunkPath& chunk) const;
    // Notes how much memory and disk space the volume holds. Returns false if the volume was given
    // up, now or earlier.
    [[nodiscard]] bool grew(const ChunkPath& chunk, const Shared& volume, const Growth& growth,
                            const std::string& station);
    void forget(const ChunkPath& chunk);
    // Forgets the volume of this chunk, if that volume is still `volume`.
    void forget(const ChunkPath& chunk, const Shared& volume);
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
