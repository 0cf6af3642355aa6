#include "arrayfile/hdf5_storage.h"

#include <algorithm>

namespace stormcellar::arrayfile {
namespace {

constexpr std::size_t most_filters = 16;
constexpr std::size_t most_chunks = 1'000'000;

// Parses the layout message of versions 1 and 2.
bool parse_old_layout(const Hdf5Bytes& file, Cursor& cursor, Storage& storage) {
    const std::size_t rank = cursor.u8();
    const int kind = cursor.u8();
    cursor.skip(5);
    if (kind != 0) storage.address = file.address(cursor);
    std::vector<std::uint64_t> sizes;
    for (std::size_t i = 0; i < rank; ++i)
        sizes.push_back(cursor.u32());
    if (kind == 2 && sizes.size() > 1) {
        storage.kind = Storage::Kind::chunks;
        storage.chunk.assign(sizes.begin(), sizes.end() - 1);
    } else if (kind == 1) {
        storage.kind = Storage::Kind::contiguous;
        storage.size_bytes = ~std::uint64_t{0};  // the shape tells it
    }
    return !cursor.failed() && kind == static_cast<int>(storage.kind == Storage::Kind::chunks) + 1;
}

// Parses the part of a version 4 layout that describes chunks.
bool parse_new_chunks(const Hdf5Bytes& file, Cursor& cursor, Storage& storage, bool& is_known) {
    const std::uint8_t flags = cursor.u8();
    const std::size_t rank = cursor.u8();
    const std::size_t width = cursor.u8();
    if (width == 0 || width > 8 || rank < 2) return false;
    for (std::size_t i = 0; i < rank; ++i)
        storage.chunk.push_back(cursor.number(width));
    storage.chunk.pop_back();  // the size of an element
    const int index = cursor.u8();
    if (index == 1) {
        storage.index = Storage::Index::single;
        if ((flags & 2) != 0) {
            storage.size_bytes = file.length(cursor);
            storage.filter_mask = cursor.u32();
        }
    } else if (index == 2) {
        storage.index = Storage::Index::implicit;
    } else if (index == 3) {
        storage.index = Storage::Index::fixed_array;
        cursor.skip(1);
    } else {
        is_known = false;
    }
    storage.address = file.address(cursor);
    return !cursor.failed();
}

Status parse_layout(const Hdf5Bytes& file, std::span<const std::byte> message, Array& array) {
    Cursor cursor{message};
    Storage& storage = array.storage;
    const int version = cursor.u8();
    bool good = true, is_known = version <= 4;
    if (version == 1 || version == 2) {
        good = parse_old_layout(file, cursor, storage);
    } else if (is_known) {
        const int kind = cursor.u8();
        if (kind == 0) {
            storage.kind = Storage::Kind::contiguous;
            storage.size_bytes = cursor.u16();
            const auto data = cursor.bytes(storage.size_bytes);
            storage.address = static_cast<std::uint64_t>(data.data() - file.all.data()) - file.base;
        } else if (kind == 1) {
            storage.kind = Storage::Kind::contiguous;
            storage.address = file.address(cursor);
            storage.size_bytes = file.length(cursor);
        } else if (kind == 2 && version == 4) {
            storage.kind = Storage::Kind::chunks;
            good = parse_new_chunks(file, cursor, storage, is_known);
        } else if (kind == 2) {
            storage.kind = Storage::Kind::chunks;
            const std::size_t rank = cursor.u8();
            storage.address = file.address(cursor);
            for (std::size_t i = 0; i + 1 < rank; ++i)
                storage.chunk.push_back(cursor.u32());
        } else {
            is_known = false;
        }
    }
    if (!is_known)
        return fail(ErrorCode::unsupported, "the array {} is stored in a way that is not read",
                    array.name);
    const bool fits = storage.kind != Storage::Kind::chunks ||
                      (storage.chunk.size() == array.shape.size() &&
                       std::ranges::find(storage.chunk, 0U) == storage.chunk.end());
    if (!good || cursor.failed() || !fits) return damaged("the layout of an array");
    if (file.is_undefined(storage.address)) storage.kind = Storage::Kind::none;
    return {};
}

bool parse_filters(std::span<const std::byte> message, std::vector<Filter>& filters) {
    Cursor cursor{message};
    const int version = cursor.u8();
    const std::size_t count = cursor.u8();
    if (version == 1) cursor.skip(6);
    for (std::size_t i = 0; i < count && i < most_filters; ++i) {
        Filter filter;
        filter.number = cursor.u16();
        const std::size_t name_bytes = version == 1 || filter.number >= 256 ? cursor.u16() : 0;
        cursor.skip(2);
        const std::size_t parameters = cursor.u16();
        cursor.skip(name_bytes);
        if (version == 1) cursor.skip((8 - name_bytes % 8) % 8);
        for (std::size_t k = 0; k < parameters && !cursor.failed(); ++k)
            filter.parameters.push_back(cursor.u32());
        if (version == 1 && parameters % 2 == 1) cursor.skip(4);
        filters.push_back(std::move(filter));
    }
    return !cursor.failed() && count <= most_filters;
}

std::vector<std::byte> parse_fill(const HeaderMessage& message) {
    Cursor cursor{message.data};
    bool is_given = true;
    if (message.type == MessageType::fill_value) {
        const int version = cursor.u8();
        if (version == 3) {
            is_given = (cursor.u8() & 0x20) != 0;
        } else {
            cursor.skip(2);
            is_given = cursor.u8() != 0;
        }
    }
    const std::uint32_t size = is_given ? cursor.u32() : 0;
    const auto bytes = cursor.bytes(size);
    return {bytes.begin(), bytes.end()};
}

// Reads the B-tree (version 1) of the chunks of an array.
class ChunkTree {
  public:
    ChunkTree(const Hdf5Bytes& file, std::size_t rank) : file_(file), rank_(rank) {}

    bool take(std::uint64_t address, std::size_t most_level) {
        Cursor node = file_.at(address);
        if (!node.takes("TREE") || node.u8() != 1 || ++nodes_ > most_chunks) return false;
        const std::size_t level = node.u8();
        const std::size_t entries = node.u16();
        node.skip(2 * file_.offset_bytes);
        if (node.failed() || level > most_level) return false;
        for (std::size_t i = 0; i < entries; ++i) {
            Chunk chunk;
            chunk.size_bytes = node.u32();
            chunk.filter_mask = node.u32();
            for (std::size_t k = 0; k < rank_; ++k)
                chunk.start.push_back(node.number(8));
            node.skip(8);
            chunk.address = file_.address(node);
            if (node.failed() || chunks.size() == most_chunks) return false;
            if (level > 0) {
                if (!take(chunk.address, level - 1)) return false;
            } else {
                chunks.push_back(std::move(chunk));
            }
        }
        return true;
    }

    std::vector<Chunk> chunks = {};

  private:
    const Hdf5Bytes& file_;
    std::size_t rank_;
    std::size_t nodes_ = 0;
};

// Calls `take` with the chunks of the array in their order until it returns false.
template <class Take>
bool each_place(const Array& array, Take take) {
    std::vector<std::uint64_t> start(array.shape.size(), 0);
    for (std::size_t number = 0; number < most_chunks; ++number) {
        if (!take(start)) return false;
        std::size_t dimension = start.size();
        while (dimension-- > 0) {
            start[dimension] += array.storage.chunk[dimension];
            if (start[dimension] < array.shape[dimension]) break;
            start[dimension] = 0;
        }
        if (dimension > start.size()) return true;
    }
    return false;
}

std::uint64_t whole_chunk_bytes(const Array& array) {
    Array chunk;
    chunk.shape = array.storage.chunk;
    return chunk.count().value_or(0) * array.type.size;
}

// Reads a fixed array: one address for each chunk, and its packed size if there are filters.
bool take_fixed_array(const Hdf5Bytes& file, const Array& array, std::vector<Chunk>& chunks) {
    Cursor head = file.at(array.storage.address);
    if (!head.takes("FAHD")) return false;
    head.skip(2);
    const std::size_t entry_bytes = head.u8();
    const std::size_t page_bits = head.u8();
    const std::uint64_t entries = file.length(head);
    Cursor block = file.at(file.address(head));
    if (head.failed() || !block.takes("FADB") || page_bits >= 32) return false;
    block.skip(2 + file.offset_bytes);
    if (entries > std::uint64_t{1} << page_bits) return false;  // in pages, which are not read
    const bool is_filtered = !array.storage.filters.empty();
    if (is_filtered &&
        (entry_bytes < file.offset_bytes + 5 || entry_bytes > file.offset_bytes + 12))
        return false;
    return each_place(array, [&](const std::vector<std::uint64_t>& start) {
        Chunk chunk{start, file.address(block), whole_chunk_bytes(array), 0};
        if (is_filtered) {
            chunk.size_bytes = block.number(entry_bytes - file.offset_bytes - 4);
            chunk.filter_mask = block.u32();
        }
        if (!file.is_undefined(chunk.address)) chunks.push_back(std::move(chunk));
        return !block.failed();
    });
}

}  // namespace

Status read_storage(const Hdf5Bytes& file, std::span<const HeaderMessage> header, Array& array) {
    Storage& storage = array.storage;
    storage.offset_bytes = file.offset_bytes;
    storage.length_bytes = file.length_bytes;
    storage.base = file.base;
    for (const HeaderMessage& message : header) {
        if (message.type == MessageType::layout) {
            if (Status parsed = parse_layout(file, message.data, array); !parsed) return parsed;
        } else if (message.type == MessageType::filters) {
            if (message.is_shared || !parse_filters(message.data, storage.filters))
                return damaged("the layout of an array");
        } else if (message.type == MessageType::fill_value ||
                   message.type == MessageType::old_fill_value) {
            auto fill = parse_fill(message);
            if (fill.size() == array.type.size) storage.fill = std::move(fill);
        }
    }
    return {};
}

Result<std::vector<Chunk>> chunks_of(const Hdf5Bytes& file, const Array& array) {
    const Storage& storage = array.storage;
    std::vector<Chunk> chunks;
    const std::uint64_t bytes = whole_chunk_bytes(array);
    bool good = true;
    if (array.count().value_or(0) == 0) return chunks;
    switch (storage.index) {
        case Storage::Index::tree: {
            constexpr std::size_t most_levels = 32;
            ChunkTree tree{file, array.shape.size()};
            good = tree.take(storage.address, most_levels);
            chunks = std::move(tree.chunks);
            break;
        }
        case Storage::Index::single:
            chunks.push_back({std::vector<std::uint64_t>(array.shape.size(), 0), storage.address,
                              storage.size_bytes == 0 ? bytes : storage.size_bytes,
                              storage.filter_mask});
            break;
        case Storage::Index::implicit: {
            std::uint64_t address = storage.address;
            good = each_place(array, [&](const std::vector<std::uint64_t>& start) {
                chunks.push_back({start, address, bytes, 0});
                address += bytes;
                return address <= file.all.size();
            });
            break;
        }
        case Storage::Index::fixed_array:
            good = take_fixed_array(file, array, chunks);
            break;
    }
    if (!good) return damaged("the index of an array");
    return chunks;
}

}  // namespace stormcellar::arrayfile
