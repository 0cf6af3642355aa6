#include "arrayfile/stored_elements.h"

#include <algorithm>

#include <zlib.h>

#include "arrayfile/hdf5_storage.h"

namespace stormcellar::arrayfile {
namespace {

enum FilterNumber { deflate = 1, shuffle = 2, checksum = 3 };

// Unpacks zlib data of at most this many bytes. Returns false for damaged data or more bytes.
bool inflate_into(std::span<const std::byte> packed, std::vector<std::byte>& to,
                  std::uint64_t most_bytes) {
    to.resize(static_cast<std::size_t>(most_bytes));
    auto size = static_cast<uLongf>(to.size());
    const int code = uncompress(reinterpret_cast<Bytef*>(to.data()), &size,
                                reinterpret_cast<const Bytef*>(packed.data()),
                                static_cast<uLong>(packed.size()));
    to.resize(static_cast<std::size_t>(size));
    return code == Z_OK;
}

// Puts the bytes of each element together again: the shuffled form has all first bytes, then all
// second bytes, and so on. Bytes after the last whole element stay.
void unshuffle(std::vector<std::byte>& bytes, std::size_t element_bytes) {
    if (element_bytes < 2) return;
    const std::size_t count = bytes.size() / element_bytes;
    std::vector<std::byte> plain = bytes;
    for (std::size_t part = 0; part < element_bytes; ++part) {
        for (std::size_t i = 0; i < count; ++i)
            plain[i * element_bytes + part] = bytes[part * count + i];
    }
    bytes = std::move(plain);
}

class ChunkReader {
  public:
    ChunkReader(const Hdf5Bytes& file, const Array& array, std::span<std::byte> to)
        : file_(file), array_(array), to_(to) {}

    Status read(const std::vector<Chunk>& chunks) {
        Array whole;
        whole.shape = array_.storage.chunk;
        const auto count = whole.count();
        if (!count || *count > most_chunk_bytes / array_.type.size)
            return fail(ErrorCode::unsupported, "the array {} has chunks of more than {} bytes",
                        array_.name, most_chunk_bytes);
        chunk_bytes_ = *count * array_.type.size;
        // A sound file has each chunk once.
        std::uint64_t places = 1;
        for (std::size_t i = 0; i < array_.shape.size(); ++i)
            places *= (array_.shape[i] + array_.storage.chunk[i] - 1) / array_.storage.chunk[i];
        if (chunks.size() > places) return damaged("the index of an array");
        // Chunks may reach beyond the array, but not so far that they take long to unpack.
        constexpr std::uint64_t most_spare = 64;
        if (chunks.size() * chunk_bytes_ > most_spare * to_.size() + most_chunk_bytes)
            return fail(ErrorCode::unsupported, "the array {} has chunks far larger than itself",
                        array_.name);
        for (const Chunk& chunk : chunks) {
            if (Status taken = take(chunk); !taken) return taken;
        }
        return {};
    }

  private:
    Status take(const Chunk& chunk) {
        for (std::size_t i = 0; i < chunk.start.size(); ++i) {
            if (chunk.start[i] >= array_.shape[i] || chunk.start[i] % array_.storage.chunk[i] != 0)
                return damaged("the index of an array");
        }
        Cursor cursor = file_.at(chunk.address);
        const auto packed = cursor.bytes(chunk.size_bytes);
        if (cursor.failed())
            return fail(ErrorCode::truncated, "the array {} is cut off", array_.name);
        std::vector<std::byte> bytes(packed.begin(), packed.end());
        if (Status unpacked = unpack(bytes, chunk.filter_mask); !unpacked) return unpacked;
        if (bytes.size() < chunk_bytes_)
            return fail(ErrorCode::corrupt, "a part of the array {} is too short", array_.name);
        place(bytes.data(), chunk.start, 0, 0, 0);
        return {};
    }

    // Undoes the filters, the last one first.
    Status unpack(std::vector<std::byte>& bytes, std::uint32_t mask) {
        for (std::size_t i = array_.storage.filters.size(); i-- > 0;) {
            const Filter& filter = array_.storage.filters[i];
            if ((mask >> i & 1) != 0) continue;
            if (filter.number == deflate) {
                // Filters that are undone later may take some bytes away.
                constexpr std::uint64_t spare_bytes = 16;
                std::vector<std::byte> plain;
                if (!inflate_into(bytes, plain, chunk_bytes_ + spare_bytes))
                    return fail(ErrorCode::corrupt, "a packed part of the array {} is damaged",
                                array_.name);
                bytes = std::move(plain);
            } else if (filter.number == shuffle) {
                const auto size = filter.parameters.empty()
                                      ? array_.type.size
                                      : static_cast<std::size_t>(filter.parameters[0]);
                unshuffle(bytes, std::min(size, bytes.size()));
            } else if (filter.number == checksum) {
                bytes.resize(bytes.size() < 4 ? 0 : bytes.size() - 4);
            } else {
                return fail(ErrorCode::unsupported,
                            "the array {} is packed with HDF5 filter {}, which is not read; "
                            "h5repack -f GZIP=6 packs it anew",
                            array_.name, filter.number);
            }
        }
        return {};
    }

    // Copies the rows of a chunk, dimension by dimension, and leaves out what is beyond the array.
    void place(const std::byte* from, const std::vector<std::uint64_t>& start,
               std::size_t dimension, std::uint64_t from_at, std::uint64_t to_at) {
        const std::uint64_t chunk = array_.storage.chunk[dimension], size = array_.shape[dimension];
        const std::uint64_t count = std::min(chunk, size - start[dimension]);
        const std::uint64_t from_row = from_at * chunk;
        const std::uint64_t to_row = to_at * size + start[dimension];
        if (dimension + 1 == array_.shape.size()) {
            const std::size_t element = array_.type.size;
            std::copy_n(from + from_row * element, count * element,
                        to_.begin() + static_cast<std::ptrdiff_t>(to_row * element));
            return;
        }
        for (std::uint64_t i = 0; i < count; ++i)
            place(from, start, dimension + 1, from_row + i, to_row + i);
    }

    const Hdf5Bytes& file_;
    const Array& array_;
    std::span<std::byte> to_;
    std::uint64_t chunk_bytes_ = 0;
};

void fill(const Array& array, std::span<std::byte> to) {
    const auto& value = array.storage.fill;
    for (std::size_t at = 0; !value.empty() && at + value.size() <= to.size(); at += value.size())
        std::ranges::copy(value, to.begin() + static_cast<std::ptrdiff_t>(at));
}

Status copy_records(std::span<const std::byte> file, const Array& array, std::span<std::byte> to) {
    const Storage& storage = array.storage;
    const std::uint64_t records = array.shape.empty() ? 0 : array.shape[0];
    if (records == 0) return {};
    const std::uint64_t size = to.size() / records;
    for (std::uint64_t i = 0; i < records; ++i) {
        const std::uint64_t at = storage.address + i * storage.record_bytes;
        if (at > file.size() || size > file.size() - at)
            return fail(ErrorCode::truncated, "the array {} is cut off", array.name);
        std::ranges::copy(
            file.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(size)),
            to.begin() + static_cast<std::ptrdiff_t>(i * size));
    }
    return {};
}

}  // namespace

Status copy_elements(std::span<const std::byte> file, const Array& array, std::span<std::byte> to) {
    const Storage& storage = array.storage;
    const Hdf5Bytes bytes{file, storage.offset_bytes, storage.length_bytes, storage.base};
    switch (storage.kind) {
        case Storage::Kind::none:
            fill(array, to);
            return {};
        case Storage::Kind::records:
            return copy_records(file, array, to);
        case Storage::Kind::contiguous: {
            Cursor cursor = bytes.at(storage.address);
            const auto data = cursor.bytes(to.size());
            if (cursor.failed() || storage.size_bytes < to.size())
                return fail(ErrorCode::truncated, "the array {} is cut off", array.name);
            std::ranges::copy(data, to.begin());
            return {};
        }
        case Storage::Kind::chunks: {
            const auto chunks = chunks_of(bytes, array);
            if (!chunks) return pass_on(chunks);
            fill(array, to);
            return ChunkReader{bytes, array, to}.read(*chunks);
        }
    }
    return {};
}

}  // namespace stormcellar::arrayfile
