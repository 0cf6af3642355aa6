#include "arrayfile/hdf5_values.h"

#include "arrayfile/hdf5_heaps.h"

namespace stormcellar::arrayfile {
namespace {

enum TypeClass { integer = 0, floating = 1, text = 3, enumeration = 8, varying = 9 };
constexpr int reference = 7;
constexpr int most_nested_types = 3;

// Returns true if the properties describe a float or double of IEEE 754.
bool is_ieee(Cursor& properties, std::uint32_t size) {
    const std::uint16_t offset = properties.u16(), precision = properties.u16();
    const int exponent_at = properties.u8(), exponent_bits = properties.u8();
    const int mantissa_at = properties.u8(), mantissa_bits = properties.u8();
    if (properties.failed() || offset != 0 || mantissa_at != 0) return false;
    if (size == 4)
        return precision == 32 && exponent_at == 23 && exponent_bits == 8 && mantissa_bits == 23;
    return size == 8 && precision == 64 && exponent_at == 52 && exponent_bits == 11 &&
           mantissa_bits == 52;
}

bool is_whole_integer(Cursor& properties, std::uint32_t size) {
    const std::uint16_t offset = properties.u16(), precision = properties.u16();
    return !properties.failed() && offset == 0 && size <= 8 && size > 0 && precision == 8 * size;
}

// Reads the texts or the references that elements of varying length point at. Keeps the first text.
void read_varying(const Hdf5Bytes& file, const Hdf5Type& type, Cursor& data, std::uint64_t count,
                  Value& value) {
    value.is_text = type.form == Hdf5Type::Form::varying_text;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t length = data.u32();
        const std::uint64_t collection = file.address(data);
        const std::uint32_t index = data.u32();
        if (data.failed()) return;
        const auto object = length == 0 ? std::nullopt : global_object(file, collection, index);
        if (value.is_text) {
            if (object && object->size() >= length)
                value.text = before_zero(Cursor{*object}.text(length));
            return;
        }
        Cursor first{object.value_or(std::span<const std::byte>{})};
        value.numbers.push_back(static_cast<double>(file.address(first)));
    }
}

void read_plain(const ElementType& type, Cursor& data, std::uint64_t count, Value& value) {
    value.is_text = type.kind == ElementKind::text;
    if (value.is_text) {
        if (count > 0) value.text = before_zero(data.text(type.size));
        return;
    }
    const auto bytes = data.bytes(count * type.size);
    for (std::size_t at = 0; at < bytes.size(); at += type.size)
        value.numbers.push_back(number_at(bytes.data() + at, type));
}

}  // namespace

std::optional<Hdf5Type> parse_type(std::span<const std::byte> message, int depth) {
    Cursor cursor{message};
    const int kind = cursor.u8() & 15;
    const std::uint8_t bits = cursor.u8();
    cursor.skip(2);
    const std::uint32_t size = cursor.u32();
    if (cursor.failed() || size == 0 || depth > most_nested_types) return std::nullopt;
    Hdf5Type type;
    type.element.size = size;
    type.element.big_endian = (bits & 1) != 0;
    if (kind == integer && is_whole_integer(cursor, size)) {
        type.element.kind =
            (bits & 8) != 0 ? ElementKind::signed_integer : ElementKind::unsigned_integer;
    } else if (kind == floating && (bits & 64) == 0 && is_ieee(cursor, size)) {
        type.element.kind = ElementKind::floating;
    } else if (kind == text) {
        type.element.kind = ElementKind::text;
    } else if (kind == enumeration) {
        const auto base = parse_type(message.subspan(8), depth + 1);
        if (!base) return std::nullopt;
        if (base->element.size == size) type = *base;
    } else if (kind == varying) {
        const auto base = parse_type(message.subspan(8), depth + 1);
        if (!base) return std::nullopt;
        type.form = Hdf5Type::Form::other;
        if ((bits & 15) == 1) type.form = Hdf5Type::Form::varying_text;
        const int base_class = std::to_integer<int>(message[8]) & 15;
        if ((bits & 15) == 0 && base_class == reference)
            type.form = Hdf5Type::Form::varying_references;
    } else {
        type.form = Hdf5Type::Form::other;
    }
    return type;
}

std::optional<std::vector<std::uint64_t>> parse_shape(const Hdf5Bytes& file,
                                                      std::span<const std::byte> message) {
    Cursor cursor{message};
    const int version = cursor.u8();
    const std::size_t rank = cursor.u8();
    cursor.skip(1);
    const int kind = cursor.u8();  // of version 2: 0 one element, 1 an array, 2 nothing
    if (version == 1) cursor.skip(4);
    if (version == 2 && kind == 2) return std::vector<std::uint64_t>{0};
    std::vector<std::uint64_t> shape;
    for (std::size_t i = 0; i < rank; ++i)
        shape.push_back(file.length(cursor));
    if (cursor.failed() || rank > 32 || version < 1 || version > 2) return std::nullopt;
    return shape;
}

std::optional<Hdf5Attribute> parse_attribute(const Hdf5Bytes& file,
                                             std::span<const std::byte> message,
                                             std::uint64_t& bytes) {
    Cursor cursor{message};
    const int version = cursor.u8();
    const std::uint8_t flags = cursor.u8();
    const std::size_t name_bytes = cursor.u16(), type_bytes = cursor.u16(),
                      shape_bytes = cursor.u16();
    if (version == 3) cursor.skip(1);
    const auto part = [&](std::size_t size) {
        const auto taken = cursor.bytes(size);
        if (version == 1) cursor.skip((8 - size % 8) % 8);
        return taken;
    };
    Hdf5Attribute attribute;
    const auto name = part(name_bytes);
    attribute.name = before_zero(Cursor{name}.text(name.size()));
    const auto type_message = part(type_bytes);
    const auto shape_message = part(shape_bytes);
    if (cursor.failed() || version < 1 || version > 3) return std::nullopt;
    if (version > 1 && flags != 0) return attribute;  // its type is elsewhere
    const auto type = parse_type(type_message);
    const auto shape = parse_shape(file, shape_message);
    if (!type || !shape) return std::nullopt;
    Array counted;
    counted.shape = *shape;
    const std::uint64_t size = type->element.size, count = counted.count().value_or(~0ULL);
    bytes = cursor.remaining();
    if (count > cursor.remaining() / size) return std::nullopt;
    if (type->form == Hdf5Type::Form::other) return attribute;
    const bool is_varying = type->form != Hdf5Type::Form::plain;
    if (is_varying && size != 8 + file.offset_bytes) return attribute;
    if (!is_varying && type->element.kind == ElementKind::other) return attribute;
    attribute.value.emplace();
    if (is_varying)
        read_varying(file, *type, cursor, count, *attribute.value);
    else
        read_plain(type->element, cursor, count, *attribute.value);
    return attribute;
}

}  // namespace stormcellar::arrayfile
