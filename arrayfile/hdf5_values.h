// arrayfile/hdf5_values.h -- types, shapes and attributes of HDF5.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrayfile/array_file.h"
#include "arrayfile/hdf5_bytes.h"

namespace stormcellar::arrayfile {

struct Hdf5Type {
    enum class Form : std::uint8_t { plain, varying_text, varying_references, other };
    Form form = Form::plain;
    ElementType element;  // of a plain type; `size` is right for every form
};

// Parses a datatype message. Types that have no form here become `other`. Returns none for damaged
// bytes.
[[nodiscard]] std::optional<Hdf5Type> parse_type(std::span<const std::byte> message, int depth = 0);

// Parses a dataspace message. Returns none for damaged bytes. A null space has one dimension of
// size 0.
[[nodiscard]] std::optional<std::vector<std::uint64_t>> parse_shape(
    const Hdf5Bytes& file, std::span<const std::byte> message);

struct Hdf5Attribute {
    std::string name;
    std::optional<Value> value;  // none if this reader does not read its type
};

// Parses an attribute message. Sets `bytes` to what the value takes in memory. The value of an
// attribute of references, such as DIMENSION_LIST, is the first address of each element.
[[nodiscard]] std::optional<Hdf5Attribute> parse_attribute(const Hdf5Bytes& file,
                                                           std::span<const std::byte> message,
                                                           std::uint64_t& bytes);

}  // namespace stormcellar::arrayfile
