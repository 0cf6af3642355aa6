// cli/picture/still_output.h -- the output of `frame`: which format of stills it has
// (stormcellar/render/still.h), and how it is written.
//
// "-" is a PNG on standard output; "-.webp" is another format there.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {

// Checks before long work that the output can be written, that its format shows the product, and
// that standard output is not also used for `json`. Errors: bad_argument, and those of
// check_target().
[[nodiscard]] Status check_still_output(const std::string& output, render::Product product,
                                        bool json);

// Returns the format of an output that was checked.
[[nodiscard]] const render::StillFormat& still_format(const std::string& output);

// Returns the whole output, in memory, to its place. Errors: those of writing.
[[nodiscard]] Status write_still(const std::string& output, std::span<const std::byte> bytes);

// Returns what -o takes, for help.
[[nodiscard]] std::string still_help();

// Reads --geotiff. Errors: bad_argument, naming the option, also for an output that is no GeoTIFF.
[[nodiscard]] Result<render::TiffContent> parse_tiff_content(const std::string& name,
                                                             const std::string& output);

}  // namespace stormcellar::cli
