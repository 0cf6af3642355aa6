// arrayfile/hdf5_tree.h -- the groups and arrays of an HDF5 file.
//
// Threads   A pure function.
#pragma once

#include <cstddef>
#include <span>

#include "arrayfile/array_file.h"

namespace stormcellar::arrayfile {

[[nodiscard]] Result<Group> read_hdf5_tree(std::span<const std::byte> bytes);

}  // namespace stormcellar::arrayfile
