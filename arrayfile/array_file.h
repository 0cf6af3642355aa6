// arrayfile/array_file.h -- reads files of named arrays from bytes: HDF5 (which includes
// netCDF-4) and classic netCDF.
//
// read_tree() returns groups, attributes and the shapes of arrays; read_array() reads one array.
// The input is hostile, so every address, length and count is bounded before it is used. The reader
// knows what weather radar files hold: contiguous, compact and chunked arrays; the filters deflate,
// shuffle and checksum; integers, floats and texts; groups of old and new form. Attributes of other
// types are left out.
//
// Threads   Pure functions.
// Errors    corrupt or truncated: the file contradicts itself, or ends early. unsupported: the file
//           needs a feature that this reader does not have, or exceeds a limit.
// Source    HDF5 File Format Specification 3.0; netCDF Classic and 64-bit Offset Format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::arrayfile {

// Limits of a file. No known radar file comes near them.
inline constexpr std::size_t most_objects = 20'000;
inline constexpr int most_depth = 8;  // of groups
inline constexpr std::uint64_t most_attribute_bytes = std::uint64_t{32} << 20;
inline constexpr std::uint64_t most_chunk_bytes = std::uint64_t{256} << 20;

[[nodiscard]] bool is_hdf5(std::span<const std::byte> bytes);
[[nodiscard]] bool is_classic_netcdf(std::span<const std::byte> bytes);

enum class ElementKind : std::uint8_t { signed_integer, unsigned_integer, floating, text, other };

struct ElementType {
    ElementKind kind = ElementKind::other;
    std::size_t size = 0;  // bytes of an element
    bool big_endian = false;

    [[nodiscard]] bool is_number() const {
        return kind != ElementKind::text && kind != ElementKind::other;
    }
};

// Returns a number at the start of the bytes, which must hold a number of this type.
[[nodiscard]] double number_at(const std::byte* bytes, const ElementType& type);

// The value of an attribute: a text, or numbers.
struct Value {
    bool is_text = false;
    std::string text;  // of several texts, the first
    std::vector<double> numbers;
};

struct Attributes {
    std::vector<std::pair<std::string, Value>> all;

    [[nodiscard]] const Value* find(std::string_view name) const;
    // Returns the text, without blanks at its end, or none.
    [[nodiscard]] std::optional<std::string> text(std::string_view name) const;
    // Returns the first number. A text with a number counts as the number.
    [[nodiscard]] std::optional<double> number(std::string_view name) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const;
};

struct Filter {
    int number = 0;  // as HDF5 registers it: 1 deflate, 2 shuffle, 3 checksum
    std::vector<std::uint32_t> parameters;
};

// The place of an array's elements in the file.
struct Storage {
    enum class Kind : std::uint8_t { none, contiguous, records, chunks } kind = Kind::none;
    enum class Index : std::uint8_t { tree, single, implicit, fixed_array } index = Index::tree;
    std::uint64_t address = 0;       // of the elements, or of the index of chunks
    std::uint64_t size_bytes = 0;    // contiguous: of all elements; single: of the packed chunk
    std::uint64_t record_bytes = 0;  // records: from one record to the next
    std::vector<std::uint64_t> chunk;
    std::vector<Filter> filters;
    std::uint32_t filter_mask = 0;     // of a single chunk
    std::vector<std::byte> fill = {};  // of elements that were never written; empty: zeros
    std::size_t offset_bytes = 8;      // of addresses in the file
    std::size_t length_bytes = 8;
    std::uint64_t base = 0;  // of addresses
};

struct Array {
    std::string name;
    ElementType type;
    std::vector<std::uint64_t> shape;     // empty: a single element
    std::vector<std::string> dimensions;  // names; empty if the file has none
    Attributes attributes;
    Storage storage;

    // Returns the number of elements, or none if the number does not fit into 64 bits.
    [[nodiscard]] std::optional<std::uint64_t> count() const;
};

struct Group {
    std::string name;
    Attributes attributes;
    std::vector<Group> groups;
    std::vector<Array> arrays;

    [[nodiscard]] const Group* group(std::string_view name_of_group) const;
    [[nodiscard]] const Array* array(std::string_view name_of_array) const;
};

// The elements of an array in the order of the file, the last dimension fastest.
class Elements {
  public:
    Elements() = default;
    Elements(std::vector<std::byte> bytes, ElementType type)
        : bytes_(std::move(bytes)), type_(type) {}

    [[nodiscard]] std::size_t size() const {
        return type_.size == 0 ? 0 : bytes_.size() / type_.size;
    }
    [[nodiscard]] double operator[](std::size_t index) const {
        return number_at(bytes_.data() + index * type_.size, type_);
    }
    [[nodiscard]] const ElementType& type() const { return type_; }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
    ElementType type_;
};

[[nodiscard]] Result<Group> read_tree(std::span<const std::byte> bytes);
// Reads an array of the tree of these bytes. Error `unsupported` if it takes more than
// `most_bytes`.
[[nodiscard]] Result<Elements> read_array(std::span<const std::byte> bytes, const Array& array,
                                          std::uint64_t most_bytes);

}  // namespace stormcellar::arrayfile
