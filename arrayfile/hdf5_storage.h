// arrayfile/hdf5_storage.h -- parses the messages that say where the elements of an array are.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arrayfile/array_file.h"
#include "arrayfile/hdf5_bytes.h"
#include "arrayfile/hdf5_header.h"

namespace stormcellar::arrayfile {

// Fills the storage of an array, whose shape and type are known, from its header.
[[nodiscard]] Status read_storage(const Hdf5Bytes& file, std::span<const HeaderMessage> header,
                                  Array& array);

struct Chunk {
    std::vector<std::uint64_t> start;  // index of its first element in each dimension
    std::uint64_t address = 0;
    std::uint64_t size_bytes = 0;   // as packed
    std::uint32_t filter_mask = 0;  // bit i: filter i was not used
};

// Returns the chunks that were written.
[[nodiscard]] Result<std::vector<Chunk>> chunks_of(const Hdf5Bytes& file, const Array& array);

}  // namespace stormcellar::arrayfile
