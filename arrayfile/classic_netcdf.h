// arrayfile/classic_netcdf.h -- the tree of a classic netCDF file: one group.
//
// Threads   A pure function.
#pragma once

#include <cstddef>
#include <span>

#include "arrayfile/array_file.h"

namespace stormcellar::arrayfile {

[[nodiscard]] Result<Group> read_classic_netcdf(std::span<const std::byte> bytes);

}  // namespace stormcellar::arrayfile
