// pipeline/keep/sweep_shelf.h -- shelves sweeps until they are wanted again.
//
// The shelf packs sweeps with LZ4 into a file without a name, which the system removes when the
// process ends, however that happens. The sweeps of 160 growing volumes are more than a service
// should hold in memory; the page cache gives them up when memory is short. A sweep comes back bit
// for bit. Thread contract: one thread at a time calls put(); many threads may call get(), also
// during put().
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

class SweepShelf {
  public:
    struct Place {
        std::uint64_t offset = 0, packed_bytes = 0, bytes = 0;
    };

    // The directory should be on a local file system with some room. Errors: io, no_space,
    // permission.
    static Result<std::unique_ptr<SweepShelf>> make_in(const std::filesystem::path& directory);

    [[nodiscard]] Result<Place> put(const level2::Sweep& sweep);
    [[nodiscard]] Result<level2::Sweep> get(const Place& place) const;
    // Bytes on disk.
    [[nodiscard]] std::uint64_t bytes() const { return end_; }

  private:
    explicit SweepShelf(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

    Descriptor descriptor_;
    std::uint64_t end_ = 0;
};

}  // namespace stormcellar::pipeline
