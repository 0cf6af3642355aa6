// pipeline/keep/sweep_shelf.h -- stores sweeps on disk until they are needed again.
//
// A shelf packs sweeps with LZ4 into a file without a name. The file disappears when the process
// ends, even if the process crashes. The sweeps of 160 growing volumes take more memory than a
// service should hold; when memory is short, the kernel can drop the file's pages from memory. A
// sweep comes back bit for bit.
//
// Threads   One thread at a time may call put(); many threads may call get(), also during put().
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

    // Makes an empty shelf. The directory must be on a local file system. Errors: io, no_space,
    // permission.
    static Result<std::unique_ptr<SweepShelf>> make_in(const std::filesystem::path& directory);

    [[nodiscard]] Result<Place> put(const level2::Sweep& sweep);
    [[nodiscard]] Result<level2::Sweep> get(const Place& place) const;
    // Returns the size of the shelf on disk.
    [[nodiscard]] std::uint64_t bytes() const { return end_; }

  private:
    explicit SweepShelf(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

    Descriptor descriptor_;
    std::uint64_t end_ = 0;
};

}  // namespace stormcellar::pipeline
