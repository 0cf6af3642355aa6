// cache/description.h -- the description section of a file: names and notes as a list of tagged
// records. Used only inside the cache room.
//
// Strings are stored as the bytes that were given, because a file name need not be UTF-8. A reader
// skips records of an unknown kind, so a later version may add kinds.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cache {

// Encodes the parts of a description that are not in the header: sites, provenance and standard
// parallels.
[[nodiscard]] std::vector<std::byte> encode_description(const GridDescription& description);

// Decodes the parts that encode_description() encodes. Errors: corrupt if a record runs past the
// end, has an impossible size, or (in an audit) impossible numbers.
[[nodiscard]] Status decode_description(std::span<const std::byte> bytes,
                                        GridDescription& description);

}  // namespace stormcellar::cache
