// arrayfile/hdf5_bytes.h -- the bytes of an HDF5 file with the widths of its addresses and lengths.
//
// Threads   A plain value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "arrayfile/cursor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::arrayfile {

struct Hdf5Bytes {
    std::span<const std::byte> all;
    std::size_t offset_bytes = 8;  // of an address
    std::size_t length_bytes = 8;
    std::uint64_t base = 0;  // of addresses

    // Returns a cursor from this address to the end of the file. For an address outside the file,
    // the cursor has failed.
    [[nodiscard]] Cursor at(std::uint64_t address) const {
        if (address > all.size() || base > all.size() - address) {
            Cursor outside;
            outside.skip(1);
            return outside;
        }
        return Cursor{all.subspan(static_cast<std::size_t>(address + base))};
    }
    [[nodiscard]] std::uint64_t address(Cursor& cursor) const {
        return cursor.number(offset_bytes);
    }
    [[nodiscard]] std::uint64_t length(Cursor& cursor) const { return cursor.number(length_bytes); }
    // Returns true if all bits of the address are set: the file does not have what it would name.
    [[nodiscard]] bool is_undefined(std::uint64_t address) const {
        return address == (~std::uint64_t{0} >> (64 - 8 * offset_bytes));
    }
};

inline tl::unexpected<Error> damaged(const char* part) {
    return fail(ErrorCode::corrupt, "{} of the HDF5 file is damaged or cut off", part);
}

}  // namespace stormcellar::arrayfile
