#include "arrayfile/hdf5_tree.h"

#include <algorithm>
#include <map>
#include <set>

#include "arrayfile/hdf5_header.h"
#include "arrayfile/hdf5_heaps.h"
#include "arrayfile/hdf5_links.h"
#include "arrayfile/hdf5_storage.h"
#include "arrayfile/hdf5_values.h"

namespace stormcellar::arrayfile {
namespace {

struct Start {
    Hdf5Bytes file;
    std::uint64_t root = 0;  // address of the root group's header
};

// Reads the superblock.
Result<Start> read_start(std::span<const std::byte> bytes) {
    Cursor cursor{bytes};
    cursor.skip(8);
    const int version = cursor.u8();
    if (version > 3)
        return fail(ErrorCode::unsupported, "the HDF5 file is of an unknown version, {}", version);
    Start start;
    if (version < 2) cursor.skip(4);
    start.file.offset_bytes = cursor.u8();
    start.file.length_bytes = cursor.u8();
    const auto good = [](std::size_t width) { return width == 2 || width == 4 || width == 8; };
    if (!good(start.file.offset_bytes) || !good(start.file.length_bytes))
        return damaged("the start");
    cursor.skip(version < 2 ? 9 : 1);
    if (version == 1) cursor.skip(4);
    start.file.base = cursor.number(start.file.offset_bytes);
    cursor.skip(start.file.offset_bytes);
    const std::uint64_t end = cursor.number(start.file.offset_bytes);
    if (version < 2) cursor.skip(2 * start.file.offset_bytes);  // driver, name of the root
    start.root = cursor.number(start.file.offset_bytes);
    if (cursor.failed() || start.file.base > bytes.size()) return damaged("the start");
    if (end > bytes.size())
        return fail(ErrorCode::truncated, "the HDF5 file is cut off: it has {} of {} bytes",
                    bytes.size(), end);
    start.file.all = bytes;
    return start;
}

class TreeReader {
  public:
    explicit TreeReader(const Hdf5Bytes& file) : file_(file) {}

    Result<Group> read(std::uint64_t root) {
        Group group;
        const auto header = read_header(file_, root);
        if (!header) return pass_on(header);
        if (Status taken = take_group(*header, group, 0); !taken) return pass_on(taken);
        name_dimensions(group);
        return group;
    }

  private:
    Status take_group(const std::vector<HeaderMessage>& header, Group& group, int depth) {
        if (depth > most_depth)
            return fail(ErrorCode::unsupported, "the HDF5 file has groups in more than {} levels",
                        most_depth);
        if (Status taken = take_attributes(header, group.attributes); !taken) return taken;
        const auto links = links_of(file_, header);
        if (!links) return pass_on(links);
        for (const Hdf5Link& link : *links) {
            if (++objects_ > most_objects)
                return fail(ErrorCode::unsupported, "the HDF5 file has more than {} objects",
                            most_objects);
            const auto of_object = read_header(file_, link.address);
            if (!of_object) return pass_on(of_object);
            const bool is_array = std::ranges::find(*of_object, MessageType::layout,
                                                    &HeaderMessage::type) != of_object->end();
            if (is_array) {
                Array& array = group.arrays.emplace_back();
                array.name = link.name;
                if (Status taken = take_array(*of_object, array); !taken) return taken;
                names_.emplace(link.address, link.name);
            } else if (!is_group(*of_object)) {
                continue;  // a named type
            } else {
                Group& inner = group.groups.emplace_back();
                inner.name = link.name;
                if (Status taken = take_group(*of_object, inner, depth + 1); !taken) return taken;
            }
        }
        return {};
    }

    static bool is_group(const std::vector<HeaderMessage>& header) {
        return std::ranges::any_of(header, [](const HeaderMessage& message) {
            return message.type == MessageType::symbol_table ||
                   message.type == MessageType::link_info || message.type == MessageType::link;
        });
    }

    Status take_array(const std::vector<HeaderMessage>& header, Array& array) {
        for (const HeaderMessage& message : header) {
            if (message.type == MessageType::dataspace && !message.is_shared) {
                const auto shape = parse_shape(file_, message.data);
                if (!shape) return damaged("the shape of an array");
                array.shape = *shape;
            } else if (message.type == MessageType::datatype && !message.is_shared) {
                const auto type = parse_type(message.data);
                if (!type) return damaged("the type of an array");
                array.type = type->element;
            }
        }
        if (Status read = read_storage(file_, header, array); !read) {
            // Report an array that is not supported only when it is wanted, because other arrays
            // may be readable.
            if (read.error().code != ErrorCode::unsupported) return read;
            array.type.size = 0;
        }
        return take_attributes(header, array.attributes);
    }

    Status take_attribute(std::span<const std::byte> message, Attributes& to) {
        std::uint64_t bytes = 0;
        auto attribute = parse_attribute(file_, message, bytes);
        attribute_bytes_ += bytes;
        if (!attribute) return damaged("an attribute");
        if (attribute_bytes_ > most_attribute_bytes)
            return fail(ErrorCode::unsupported,
                        "the HDF5 file has attributes of more than {} bytes", most_attribute_bytes);
        if (attribute->value)
            to.all.emplace_back(std::move(attribute->name), std::move(*attribute->value));
        return {};
    }

    Status take_attributes(const std::vector<HeaderMessage>& header, Attributes& to) {
        for (const HeaderMessage& message : header) {
            if (message.type == MessageType::attribute && !message.is_shared) {
                if (Status taken = take_attribute(message.data, to); !taken) return taken;
            }
            if (message.type != MessageType::attribute_info) continue;
            Cursor cursor{message.data};
            cursor.skip(1);
            if ((cursor.u8() & 1) != 0) cursor.skip(2);
            const std::uint64_t heap = file_.address(cursor), tree = file_.address(cursor);
            if (cursor.failed()) return damaged("an attribute");
            if (file_.is_undefined(heap)) continue;
            const auto objects = heap_objects(file_, heap, tree, 0);
            if (!objects) return pass_on(objects);
            for (const auto object : *objects) {
                if (Status taken = take_attribute(object, to); !taken) return taken;
            }
        }
        return {};
    }

    // Names the dimensions of arrays. The attribute DIMENSION_LIST of netCDF-4 has their addresses.
    // An array that is itself a dimension has its own name.
    void name_dimensions(Group& group) const {
        for (Array& array : group.arrays) {
            for (const double address : array.attributes.numbers("DIMENSION_LIST")) {
                const auto found = names_.find(static_cast<std::uint64_t>(address));
                array.dimensions.push_back(found == names_.end() ? "" : found->second);
            }
            const bool is_dimension = array.attributes.text("CLASS") == "DIMENSION_SCALE";
            if (is_dimension && array.dimensions.empty()) array.dimensions = {array.name};
            if (array.dimensions.size() != array.shape.size()) array.dimensions.clear();
        }
        for (Group& inner : group.groups)
            name_dimensions(inner);
    }

    const Hdf5Bytes& file_;
    std::size_t objects_ = 0;
    std::uint64_t attribute_bytes_ = 0;
    std::map<std::uint64_t, std::string> names_;
};

}  // namespace

Result<Group> read_hdf5_tree(std::span<const std::byte> bytes) {
    const auto start = read_start(bytes);
    if (!start) return pass_on(start);
    return TreeReader{start->file}.read(start->root);
}

}  // namespace stormcellar::arrayfile
