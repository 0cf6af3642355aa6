// web/doors/s3/chunks.h -- lists raw volumes as the chunks of the public real-time bucket,
// STATION/VOLUME/YYYYMMDD-HHMMSS-NNN-T.
//
// A chunk is one LDM record of the volume's file; the first chunk also has the volume header before
// its record. So volumes that came in chunks have the bytes of their chunks. VOLUME is the number
// that the radar gave the volume, from 1 to 999. Of several volumes with the same number, only the
// newest is in the bucket. T is S for the first chunk, E for the last chunk of a complete volume,
// and I for all others. Volumes that are compressed as a whole have no chunks.
//
// Threads   S3ChunkKeys: one thread at a time. The functions are pure, but read files.
// Errors    Those of RawFiles.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/level2/chunk_name.h"
#include "web/data/raw/raw_files.h"
#include "web/doors/s3/keys.h"

namespace stormcellar::web {

struct VolumeChunk {
    int number = 0;  // counts from 1
    level2::ChunkKind kind = level2::ChunkKind::intermediate;
    std::uint64_t offset = 0, size = 0;  // bytes of the volume
};
// Returns the chunks of a volume. Leaves out a record that has not come completely. Returns none if
// the volume does not consist of LDM records.
[[nodiscard]] std::vector<VolumeChunk> chunks_of(const OpenedVolume& volume);

// Returns the ETag of a chunk, with its quotes.
[[nodiscard]] std::string chunk_tag(const RawVolume& volume, const VolumeChunk& chunk);

struct S3ChunkKey {
    std::string station;
    int volume = 0;
    UtcTime start{};
    int number = 0;
    level2::ChunkKind kind = level2::ChunkKind::intermediate;
};
// Returns the parts of a key, or none if no chunk can have this key.
[[nodiscard]] std::optional<S3ChunkKey> parse_s3_chunk_key(std::string_view key);

// The bucket of chunks during one list.
class S3ChunkKeys final : public S3Walk {
  public:
    explicit S3ChunkKeys(std::shared_ptr<RawFiles> files) : files_(std::move(files)) {}
    [[nodiscard]] Result<std::vector<S3Object>> between(std::string_view from, std::string_view end,
                                                        std::size_t most) override;
    Status complete(S3Object& object) override;

  private:
    // The newest volume of each number, by the number as text, as keys are sorted.
    using Ring = std::map<std::string, RawVolume, std::less<>>;
    [[nodiscard]] Result<const Ring*> ring_of(const std::string& station);
    [[nodiscard]] std::vector<S3Object> of_volume(const RawVolume& volume) const;

    const std::shared_ptr<RawFiles> files_;
    std::optional<std::vector<RawStation>> stations_;
    std::map<std::string, Ring> rings_;  // by station
};

}  // namespace stormcellar::web
