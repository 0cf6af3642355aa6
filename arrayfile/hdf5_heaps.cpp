#include "arrayfile/hdf5_heaps.h"

#include <algorithm>
#include <bit>

namespace stormcellar::arrayfile {
namespace {

constexpr std::size_t most_records = 100'000;
constexpr std::size_t most_record_levels = 8;

// Returns the bytes that a number up to `limit` takes.
std::size_t width_of(std::uint64_t limit) {
    return limit == 0 ? 1 : static_cast<std::size_t>((std::bit_width(limit) - 1) / 8 + 1);
}

// Reads a B-tree of version 2 from the root down.
class RecordReader {
  public:
    explicit RecordReader(const Hdf5Bytes& file) : file_(file) {}

    Result<std::vector<std::span<const std::byte>>> read(std::uint64_t address) {
        Cursor head = file_.at(address);
        if (!head.takes("BTHD")) return damaged("a B-tree");
        head.skip(2);  // version and type
        node_bytes_ = head.u32();
        record_bytes_ = head.u16();
        const std::size_t depth = head.u16();
        head.skip(2);
        const std::uint64_t root = file_.address(head);
        const std::size_t count = head.u16();
        if (head.failed() || record_bytes_ == 0 || node_bytes_ < 64 || depth > most_record_levels)
            return damaged("a B-tree");
        size_levels(depth);
        if (count > 0 && !take(root, count, depth)) return damaged("a B-tree");
        return std::move(records_);
    }

  private:
    static constexpr std::size_t node_frame_bytes = 10;  // signature, version, type, checksum

    // Computes how many records a node of each level may have, which sets the width of counts.
    void size_levels(std::size_t depth) {
        most_.assign(1, (node_bytes_ - node_frame_bytes) / record_bytes_);
        most_below_ = most_;
        for (std::size_t level = 1; level <= depth; ++level) {
            const std::size_t pointer = pointer_bytes(level);
            const std::uint64_t room = node_bytes_ - node_frame_bytes;
            most_.push_back(room < pointer ? 0 : (room - pointer) / (record_bytes_ + pointer));
            const std::uint64_t below = most_below_.back();
            most_below_.push_back((most_.back() + 1) * std::min(below, std::uint64_t{1} << 40) +
                                  most_.back());
        }
    }
    [[nodiscard]] std::size_t pointer_bytes(std::size_t level) const {
        return file_.offset_bytes + width_of(most_[0]) +
               (level > 1 ? width_of(most_below_[level - 1]) : 0);
    }

    bool take(std::uint64_t address, std::size_t count, std::size_t level) {
        Cursor node = file_.at(address);
        if (!node.takes(level == 0 ? "BTLF" : "BTIN")) return false;
        node.skip(2);
        if (count > most_[level] || records_.size() + count > most_records) return false;
        for (std::size_t i = 0; i < count; ++i)
            records_.push_back(node.bytes(record_bytes_));
        for (std::size_t i = 0; level > 0 && i <= count; ++i) {
            const std::uint64_t child = file_.address(node);
            const std::uint64_t records = node.number(width_of(most_[0]));
            if (level > 1) node.skip(width_of(most_below_[level - 1]));
            if (node.failed() || !take(child, static_cast<std::size_t>(records), level - 1))
                return false;
        }
        return !node.failed();
    }

    const Hdf5Bytes& file_;
    std::uint64_t node_bytes_ = 0;
    std::size_t record_bytes_ = 0;
    std::vector<std::uint64_t> most_, most_below_;
    std::vector<std::span<const std::byte>> records_;
};

}  // namespace

Result<std::span<const std::byte>> local_heap(const Hdf5Bytes& file, std::uint64_t address) {
    Cursor head = file.at(address);
    if (!head.takes("HEAP")) return damaged("a list of names");
    head.skip(4);
    const std::uint64_t size = file.length(head);
    head.skip(file.length_bytes);  // the free list
    const std::uint64_t data_address = file.address(head);
    Cursor data = file.at(data_address);
    const auto bytes = data.bytes(size);
    if (head.failed() || data.failed()) return damaged("a list of names");
    return bytes;
}

std::optional<std::span<const std::byte>> global_object(const Hdf5Bytes& file,
                                                        std::uint64_t collection,
                                                        std::uint32_t index) {
    Cursor cursor = file.at(collection);
    if (!cursor.takes("GCOL")) return std::nullopt;
    cursor.skip(4);
    const std::uint64_t size = file.length(cursor);
    const std::size_t head = 8 + file.length_bytes;
    if (cursor.failed() || size < head) return std::nullopt;
    Cursor objects{cursor.bytes(size - head)};
    while (objects.remaining() >= 8 + file.length_bytes) {
        const std::uint32_t found = objects.u16();
        objects.skip(6);
        const std::uint64_t length = file.length(objects);
        const auto data = objects.bytes(length);
        if (found == 0 || objects.failed()) return std::nullopt;
        if (found == index) return data;
        objects.skip((8 - length % 8) % 8);
    }
    return std::nullopt;
}

Result<FractalHeap> FractalHeap::open(const Hdf5Bytes& file, std::uint64_t address) {
    Cursor head = file.at(address);
    if (!head.takes("FRHP")) return damaged("a heap");
    FractalHeap heap;
    heap.file_ = file;
    head.skip(1);
    heap.identifier_bytes_ = head.u16();
    if (head.u16() != 0) return fail(ErrorCode::unsupported, "the HDF5 file has a packed heap");
    head.skip(1);
    const std::uint64_t most_object_bytes = head.u32();
    head.skip(file.length_bytes);  // the next number of a huge object
    heap.huge_tree_ = file.address(head);
    head.skip(file.offset_bytes + 9 * file.length_bytes);
    heap.width_ = head.u16();
    heap.start_bytes_ = file.length(head);
    heap.most_direct_bytes_ = file.length(head);
    heap.offset_bits_ = head.u16();
    head.skip(2);
    heap.root_ = file.address(head);
    heap.rows_ = head.u16();
    const bool good = !head.failed() && heap.width_ > 0 && heap.width_ <= 1024 &&
                      std::has_single_bit(heap.start_bytes_) &&
                      std::has_single_bit(heap.most_direct_bytes_) &&
                      heap.start_bytes_ <= heap.most_direct_bytes_ &&
                      heap.most_direct_bytes_ <= std::uint64_t{1} << 32 && heap.offset_bits_ > 0 &&
                      heap.offset_bits_ <= 64 && heap.rows_ < 30;
    if (!good) return damaged("a heap");
    heap.length_width_ = std::min(width_of(heap.most_direct_bytes_), width_of(most_object_bytes));
    return heap;
}

Result<std::span<const std::byte>> FractalHeap::object(
    std::span<const std::byte> identifier) const {
    Cursor cursor{identifier};
    const int kind = (cursor.u8() >> 4) & 3;
    if (kind == 2) {  // the object is in the identifier
        const auto first = std::to_integer<std::size_t>(identifier[0]);
        const auto data = cursor.bytes((first & 15) + 1);
        if (cursor.failed()) return damaged("a heap");
        return data;
    }
    if (kind == 1) {
        const auto data = huge(cursor);
        if (!data) return damaged("a heap");
        return *data;
    }
    const std::uint64_t offset = cursor.number((offset_bits_ + 7) / 8);
    const std::uint64_t length = cursor.number(length_width_);
    const auto data = cursor.failed() ? std::nullopt : managed(offset, length);
    if (!data) return damaged("a heap");
    return *data;
}

// Finds an object that has its own place in the file. A long identifier holds the place. A short
// identifier holds a number, for which a B-tree gives the place.
std::optional<std::span<const std::byte>> FractalHeap::huge(Cursor identifier) const {
    const std::size_t place_bytes = file_.offset_bytes + file_.length_bytes;
    std::uint64_t address = 0, length = 0;
    if (identifier.remaining() >= place_bytes) {
        address = file_.address(identifier);
        length = file_.length(identifier);
    } else {
        const std::uint64_t wanted =
            identifier.number(std::min(identifier.remaining(), file_.length_bytes));
        const auto records = tree_records(file_, huge_tree_);
        bool is_found = false;
        for (std::size_t i = 0; records && i < records->size() && !is_found; ++i) {
            Cursor record{(*records)[i]};
            address = file_.address(record);
            length = file_.length(record);
            is_found = file_.length(record) == wanted && !record.failed();
        }
        if (!is_found) return std::nullopt;
    }
    Cursor data = file_.at(address);
    const auto bytes = data.bytes(length);
    return data.failed() ? std::nullopt : std::optional{bytes};
}

// Finds the direct block that has this offset. The blocks of a heap double in size from row to row;
// blocks larger than the largest direct block are indirect blocks, which have rows of their own.
std::optional<std::span<const std::byte>> FractalHeap::managed(std::uint64_t offset,
                                                               std::uint64_t length) const {
    std::uint64_t address = root_, block_bytes = start_bytes_;
    std::size_t rows = rows_;
    while (rows > 0) {
        Cursor block = file_.at(address);
        if (!block.takes("FHIB")) return std::nullopt;
        block.skip(1 + file_.offset_bytes + (offset_bits_ + 7) / 8);
        std::size_t row = 0;
        while (row < rows && offset >= row_bytes(row) * width_) {
            offset -= row_bytes(row) * width_;
            ++row;
        }
        if (row == rows) return std::nullopt;
        block_bytes = row_bytes(row);
        block.skip((row * width_ + offset / block_bytes) * file_.offset_bytes);
        offset %= block_bytes;
        address = file_.address(block);
        if (block.failed()) return std::nullopt;
        if (block_bytes <= most_direct_bytes_) break;
        const std::uint64_t first_row_bytes = start_bytes_ * width_;
        std::size_t inner_rows = 1;
        while (inner_rows < rows && first_row_bytes << (inner_rows - 1) < block_bytes)
            ++inner_rows;
        if (inner_rows >= rows) return std::nullopt;
        rows = inner_rows;
    }
    Cursor block = file_.at(address);
    if (!block.takes("FHDB") || offset < 4 || offset > block_bytes || length > block_bytes - offset)
        return std::nullopt;
    block.skip(offset - 4);
    const auto data = block.bytes(length);
    return block.failed() ? std::nullopt : std::optional{data};
}

Result<std::vector<std::span<const std::byte>>> tree_records(const Hdf5Bytes& file,
                                                             std::uint64_t address) {
    return RecordReader{file}.read(address);
}

}  // namespace stormcellar::arrayfile
