// pipeline/drop_names.h -- which names in the drop directory are files to take.
//
// A writer that is not done hides its file: a dot in front (pqact's dot-file, rsync, our own
// temporary files) or an ending that says so. Such names are left alone until they are renamed.
// Nothing else is read from a name: content decides.
#pragma once

#include <string_view>

namespace stormcellar::pipeline {

// True for the last part of a path that begins with '.', ends with '~', or ends in .tmp, .temp,
// .part, .partial or .filepart (lower case, as programs write them).
[[nodiscard]] bool is_temporary_name(std::string_view name);

}  // namespace stormcellar::pipeline
