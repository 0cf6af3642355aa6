// level2/foreign/odim.h -- polar volumes and scans of ODIM_H5, versions 2.0 to 2.4.
//
// Threads   Pure functions.
// Errors    unsupported: an object that is no volume or scan. corrupt: nothing readable.
// Source    OPERA Data Information Model for HDF5 (EUMETNET), versions 2.0 to 2.4.
#pragma once

#include "arrayfile/array_file.h"
#include "level2/foreign/polar_file.h"
#include "stormcellar/base/result.h"

namespace stormcellar::level2 {

[[nodiscard]] bool is_odim(const arrayfile::Group& root);
// The result refers to the tree, which must outlive it.
[[nodiscard]] Result<PolarFile> read_odim(const arrayfile::Group& root);

}  // namespace stormcellar::level2
