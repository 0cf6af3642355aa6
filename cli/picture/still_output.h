// cli/picture/still_output.h -- the output of `frame`: its format (stormcellar/render/still.h), and
// how it is written.
//
// "-" means a PNG on standard output; "-.webp" means WebP on standard output, and so on.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {

// Checks, before the long work begins, that the output can be written, that its format can show the
// product, and that `json` does not use standard output as well. Errors: bad_argument, and those of
// check_target().
[[nodiscard]] Status check_still_output(const std::string& output, render::Product product,
                                        bool json);

// Refuses an overlay if the output holds a map as data. Errors: bad_argument.
[[nodiscard]] Status check_overlay_output(const std::string& output, const std::string& overlay);

// Returns the format of an output that check_still_output() has accepted.
[[nodiscard]] const render::StillFormat& still_format(const std::string& output);

// Writes a complete output, which is in memory, to its place. Errors: those of writing.
[[nodiscard]] Status write_still(const std::string& output, std::span<const std::byte> bytes);

// Returns the help text for the formats of -o.
[[nodiscard]] std::string still_help();

// Reads --geotiff. Errors: bad_argument, naming the option, also if the output is not a GeoTIFF.
[[nodiscard]] Result<render::TiffContent> parse_tiff_content(const std::string& name,
                                                             const std::string& output);

}  // namespace stormcellar::cli
