// pipeline/ingest/chunk_volumes.h -- volumes that come as one file a chunk.
//
// Chunks of one volume are the files of a directory whose names differ in the chunk's number and
// kind alone (stormcellar/level2/chunk_name.h). Whichever of them is met first, all that lie there
// are read, so that nothing depends on what was seen before: after a restart, and when a late chunk
// comes, the volume is put together again from the files. Bounded for each station and in all
// (pipeline/ingest/followed.h). A volume that was given up, and one that found no place, is read
// from its files when nothing more comes of it. Inside the pipeline room only. Thread contract: all
// may be called by many threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/ingest/chunk_volume.h"
#include "pipeline/ingest/followed.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/guarded.h"

namespace stormcellar::pipeline {

class ChunkVolumes {
  public:
    explicit ChunkVolumes(FollowedFile::Options options, GrowingLimits limits = {})
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
    [[nodiscard]] std::filesystem::path poll_for_place(const ChunkPath& chunk);
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

    FollowedFile::Options options_;
    mutable std::mutex mutex_;  // guards what follows
    Followed<std::string, Guarded<ChunkVolume>> volumes_;
    std::map<std::string, std::filesystem::path> representatives_;  // of those that found no place
};

}  // namespace stormcellar::pipeline
