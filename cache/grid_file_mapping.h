// cache/grid_file_mapping.h -- the contents of an open grid file. Used only inside the cache room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "cache/file_io.h"
#include "cache/format.h"
#include "cache/packing.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cache {

struct GridFile::Mapping {
    std::filesystem::path path;
    Descriptor file;
    std::vector<std::byte> metadata;  // all bytes before the codes, checked
    std::optional<Map> map;           // none: the codes are packed
    SparseMemory unpacked;
    format::Layout at;
    std::uint64_t bytes_on_disk = 0;
    std::uint64_t checksum = 0;  // of the header
    GridDescription description;
    grid::BrickView view;

    [[nodiscard]] Status check_map() const;
    [[nodiscard]] Status check_unchanged_size() const;
    [[nodiscard]] Status check_metadata() const;
    [[nodiscard]] Status check_stored_bricks() const;
    // Reads the codes of a stored brick at `offset`, and advances `offset` to the codes of the next
    // stored brick.
    [[nodiscard]] Status read_brick(std::size_t brick, std::uint64_t& offset,
                                    std::span<std::byte> codes) const;
    [[nodiscard]] Status check_holes() const;
    [[nodiscard]] Status check_zeros(std::uint64_t begin, std::uint64_t end) const;
    [[nodiscard]] std::uint64_t brick_bytes() const {
        return grid::brick_cells * static_cast<std::uint64_t>(view.quantization.code_bytes);
    }
};

}  // namespace stormcellar::cache
