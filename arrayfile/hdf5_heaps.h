// arrayfile/hdf5_heaps.h -- the heaps of HDF5 (local, global and fractal), and the B-trees of
// version 2 that list what a fractal heap holds.
//
// Threads   Pure functions, and a reader with constant state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arrayfile/hdf5_bytes.h"

namespace stormcellar::arrayfile {

// Returns the data of the local heap at this address.
[[nodiscard]] Result<std::span<const std::byte>> local_heap(const Hdf5Bytes& file,
                                                            std::uint64_t address);

// Returns an object of a global heap, or none if there is no such object.
[[nodiscard]] std::optional<std::span<const std::byte>> global_object(const Hdf5Bytes& file,
                                                                      std::uint64_t collection,
                                                                      std::uint32_t index);

// Finds objects of a fractal heap by their identifiers.
class FractalHeap {
  public:
    [[nodiscard]] static Result<FractalHeap> open(const Hdf5Bytes& file, std::uint64_t address);

    [[nodiscard]] std::size_t identifier_bytes() const { return identifier_bytes_; }
    [[nodiscard]] Result<std::span<const std::byte>> object(
        std::span<const std::byte> identifier) const;

  private:
    [[nodiscard]] std::uint64_t row_bytes(std::size_t row) const {
        return row == 0 ? start_bytes_ : start_bytes_ << (row - 1);
    }
    [[nodiscard]] std::optional<std::span<const std::byte>> managed(std::uint64_t offset,
                                                                    std::uint64_t length) const;
    [[nodiscard]] std::optional<std::span<const std::byte>> huge(Cursor identifier) const;

    Hdf5Bytes file_;
    std::size_t identifier_bytes_ = 0;
    std::uint64_t width_ = 0, start_bytes_ = 0, most_direct_bytes_ = 0;
    std::size_t offset_bits_ = 0, length_width_ = 0, rows_ = 0;
    std::uint64_t root_ = 0;
    std::uint64_t huge_tree_ = 0;  // B-tree of the objects that are too large for blocks
};

// Returns all records of the B-tree (version 2) at this address.
[[nodiscard]] Result<std::vector<std::span<const std::byte>>> tree_records(const Hdf5Bytes& file,
                                                                           std::uint64_t address);

}  // namespace stormcellar::arrayfile
