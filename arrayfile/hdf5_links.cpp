#include "arrayfile/hdf5_links.h"

#include <algorithm>

#include "arrayfile/array_file.h"
#include "arrayfile/hdf5_heaps.h"

namespace stormcellar::arrayfile {
namespace {

constexpr std::size_t hash_bytes = 4;
constexpr std::size_t most_levels = 32;

// Parses a link message. Returns none for a link that is left out.
std::optional<Hdf5Link> parse_link(const Hdf5Bytes& file, std::span<const std::byte> message) {
    Cursor cursor{message};
    cursor.skip(1);
    const std::uint8_t flags = cursor.u8();
    const int kind = (flags & 8) != 0 ? cursor.u8() : 0;
    if ((flags & 4) != 0) cursor.skip(8);   // order of creation
    if ((flags & 16) != 0) cursor.skip(1);  // character set
    const std::uint64_t length = cursor.number(std::size_t{1} << (flags & 3));
    Hdf5Link link{std::string{cursor.text(length)}, file.address(cursor)};
    if (cursor.failed() || kind != 0) return std::nullopt;
    return link;
}

// Reads the links of a group of the old form: a B-tree of nodes with names in a heap.
class OldGroup {
  public:
    OldGroup(const Hdf5Bytes& file, std::span<const std::byte> names)
        : file_(file), names_(names) {}

    bool take(std::uint64_t address, std::size_t most_level) {
        Cursor node = file_.at(address);
        if (links_.size() > most_objects || ++nodes_ > most_objects) return false;
        if (!node.takes("TREE")) return take_symbols(address);
        node.skip(1);
        const std::size_t level = node.u8();
        const std::size_t entries = node.u16();
        node.skip(2 * file_.offset_bytes + file_.length_bytes);
        if (node.failed() || level > most_level) return false;
        for (std::size_t i = 0; i < entries; ++i) {
            const std::uint64_t child = file_.address(node);
            node.skip(file_.length_bytes);
            if (node.failed()) return false;
            const bool good = level == 0 ? take_symbols(child) : take(child, level - 1);
            if (!good) return false;
        }
        return true;
    }
    std::vector<Hdf5Link> links() { return std::move(links_); }

  private:
    bool take_symbols(std::uint64_t address) {
        Cursor node = file_.at(address);
        if (!node.takes("SNOD")) return false;
        node.skip(2);
        const std::size_t count = node.u16();
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t name_at = file_.address(node);
            const std::uint64_t header = file_.address(node);
            const bool is_path = node.u32() == 2;
            node.skip(4 + 16);
            if (node.failed() || name_at >= names_.size() || links_.size() > most_objects)
                return false;
            const auto rest = names_.subspan(static_cast<std::size_t>(name_at));
            if (!is_path) links_.push_back({before_zero(Cursor{rest}.text(rest.size())), header});
        }
        return true;
    }

    const Hdf5Bytes& file_;
    std::span<const std::byte> names_;
    std::size_t nodes_ = 0;
    std::vector<Hdf5Link> links_;
};

Status add_old_links(const Hdf5Bytes& file, std::span<const std::byte> message,
                     std::vector<Hdf5Link>& links) {
    Cursor cursor{message};
    const std::uint64_t tree = file.address(cursor), heap = file.address(cursor);
    if (cursor.failed()) return damaged("a group");
    const auto names = local_heap(file, heap);
    if (!names) return pass_on(names);
    OldGroup group{file, *names};
    if (!group.take(tree, most_levels)) return damaged("a group");
    for (Hdf5Link& link : group.links())
        links.push_back(std::move(link));
    return {};
}

// Adds the links that are in a heap because the header has no room for them.
Status add_heap_links(const Hdf5Bytes& file, std::span<const std::byte> message,
                      std::vector<Hdf5Link>& links) {
    Cursor cursor{message};
    cursor.skip(1);
    if ((cursor.u8() & 1) != 0) cursor.skip(8);
    const std::uint64_t heap = file.address(cursor), tree = file.address(cursor);
    if (cursor.failed()) return damaged("a group");
    if (file.is_undefined(heap)) return {};
    const auto objects = heap_objects(file, heap, tree, hash_bytes);
    if (!objects) return pass_on(objects);
    for (const auto object : *objects) {
        if (auto link = parse_link(file, object)) links.push_back(std::move(*link));
    }
    return {};
}

}  // namespace

Result<std::vector<std::span<const std::byte>>> heap_objects(const Hdf5Bytes& file,
                                                             std::uint64_t heap, std::uint64_t tree,
                                                             std::size_t identifier_at) {
    const auto opened = FractalHeap::open(file, heap);
    if (!opened) return pass_on(opened);
    const auto records = tree_records(file, tree);
    if (!records) return pass_on(records);
    std::vector<std::span<const std::byte>> objects;
    for (const auto record : *records) {
        if (record.size() < identifier_at + opened->identifier_bytes()) return damaged("a heap");
        const auto object =
            opened->object(record.subspan(identifier_at, opened->identifier_bytes()));
        if (!object) return pass_on(object);
        objects.push_back(*object);
    }
    return objects;
}

Result<std::vector<Hdf5Link>> links_of(const Hdf5Bytes& file,
                                       std::span<const HeaderMessage> header) {
    std::vector<Hdf5Link> links;
    for (const HeaderMessage& message : header) {
        Status added;
        if (message.type == MessageType::symbol_table) {
            added = add_old_links(file, message.data, links);
        } else if (message.type == MessageType::link_info) {
            added = add_heap_links(file, message.data, links);
        } else if (message.type == MessageType::link) {
            if (auto link = parse_link(file, message.data)) links.push_back(std::move(*link));
        }
        if (!added) return pass_on(added);
    }
    std::ranges::sort(links, {}, &Hdf5Link::name);
    return links;
}

}  // namespace stormcellar::arrayfile
