// arrayfile/hdf5_links.h -- what a group of an HDF5 file holds.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arrayfile/hdf5_bytes.h"
#include "arrayfile/hdf5_header.h"

namespace stormcellar::arrayfile {

struct Hdf5Link {
    std::string name;
    std::uint64_t address = 0;  // of the object's header
};

// Returns the objects of the group with this header, sorted by name. Leaves out links to other
// files and links by path.
[[nodiscard]] Result<std::vector<Hdf5Link>> links_of(const Hdf5Bytes& file,
                                                     std::span<const HeaderMessage> header);

// Returns objects of a fractal heap. The records of a tree hold the identifiers of these objects,
// at this place of each record.
[[nodiscard]] Result<std::vector<std::span<const std::byte>>> heap_objects(
    const Hdf5Bytes& file, std::uint64_t heap, std::uint64_t tree, std::size_t identifier_at);

}  // namespace stormcellar::arrayfile
