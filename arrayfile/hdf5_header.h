// arrayfile/hdf5_header.h -- the messages of an object header.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "arrayfile/hdf5_bytes.h"

namespace stormcellar::arrayfile {

enum class MessageType : std::uint16_t {
    dataspace = 0x01,
    link_info = 0x02,
    datatype = 0x03,
    old_fill_value = 0x04,
    fill_value = 0x05,
    link = 0x06,
    layout = 0x08,
    filters = 0x0B,
    attribute = 0x0C,
    continuation = 0x10,
    symbol_table = 0x11,
    attribute_info = 0x15,
};

struct HeaderMessage {
    MessageType type{};
    bool is_shared = false;  // the data only point at the message
    std::span<const std::byte> data;
};

// Reads all messages of the header at this address.
[[nodiscard]] Result<std::vector<HeaderMessage>> read_header(const Hdf5Bytes& file,
                                                             std::uint64_t address);

}  // namespace stormcellar::arrayfile
