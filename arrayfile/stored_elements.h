// arrayfile/stored_elements.h -- copies the elements of an array out of a file.
//
// Threads   A pure function.
#pragma once

#include <cstddef>
#include <span>

#include "arrayfile/array_file.h"

namespace stormcellar::arrayfile {

// Copies all elements. `to` must have the size of the whole array. Elements that were never written
// get the fill value.
[[nodiscard]] Status copy_elements(std::span<const std::byte> file, const Array& array,
                                   std::span<std::byte> to);

}  // namespace stormcellar::arrayfile
