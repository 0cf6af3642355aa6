#include "arrayfile/array_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>

#include "arrayfile/classic_netcdf.h"
#include "arrayfile/hdf5_tree.h"
#include "arrayfile/stored_elements.h"

namespace stormcellar::arrayfile {
namespace {

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

bool begins_with(std::span<const std::byte> bytes, std::string_view letters) {
    return bytes.size() >= letters.size() &&
           std::string_view{reinterpret_cast<const char*>(bytes.data()), letters.size()} == letters;
}

template <class Found>
auto find_named(Found& all, std::string_view name) -> decltype(&*all.begin()) {
    const auto found = std::ranges::find_if(all, [&](const auto& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace

bool is_hdf5(std::span<const std::byte> bytes) {
    return begins_with(bytes, hdf5_signature);
}

bool is_classic_netcdf(std::span<const std::byte> bytes) {
    if (!begins_with(bytes, "CDF") || bytes.size() < 4) return false;
    const auto version = std::to_integer<int>(bytes[3]);
    return version == 1 || version == 2 || version == 5;
}

double number_at(const std::byte* bytes, const ElementType& type) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < type.size; ++i) {
        const std::size_t at = type.big_endian ? i : type.size - 1 - i;
        number = (number << 8) | std::to_integer<std::uint64_t>(bytes[at]);
    }
    if (type.kind == ElementKind::floating) {
        if (type.size == 8) return std::bit_cast<double>(number);
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(number)));
    }
    if (type.kind == ElementKind::unsigned_integer) return static_cast<double>(number);
    const auto unused_bits = static_cast<int>(64 - 8 * type.size);
    return static_cast<double>(static_cast<std::int64_t>(number << unused_bits) >> unused_bits);
}

const Value* Attributes::find(std::string_view name) const {
    const auto found =
        std::ranges::find_if(all, [&](const auto& one) { return one.first == name; });
    return found == all.end() ? nullptr : &found->second;
}

std::optional<std::string> Attributes::text(std::string_view name) const {
    const Value* value = find(name);
    if (value == nullptr || !value->is_text) return std::nullopt;
    std::string text = value->text;
    while (!text.empty() && (text.back() == ' ' || text.back() == '\n'))
        text.pop_back();
    return text;
}

std::optional<double> Attributes::number(std::string_view name) const {
    const Value* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (!value->is_text)
        return value->numbers.empty() ? std::nullopt : std::optional{value->numbers.front()};
    double number = 0;
    const char* end = value->text.data() + value->text.size();
    const auto parsed = std::from_chars(value->text.data(), end, number);
    if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
    return number;
}

std::vector<double> Attributes::numbers(std::string_view name) const {
    const Value* value = find(name);
    return value == nullptr ? std::vector<double>{} : value->numbers;
}

std::optional<std::uint64_t> Array::count() const {
    std::uint64_t count = 1;
    for (const std::uint64_t size : shape) {
        if (size != 0 && count > std::numeric_limits<std::uint64_t>::max() / size)
            return std::nullopt;
        count *= size;
    }
    return count;
}

const Group* Group::group(std::string_view name_of_group) const {
    return find_named(groups, name_of_group);
}

const Array* Group::array(std::string_view name_of_array) const {
    return find_named(arrays, name_of_array);
}

Result<Group> read_tree(std::span<const std::byte> bytes) {
    if (is_hdf5(bytes)) return read_hdf5_tree(bytes);
    if (is_classic_netcdf(bytes)) return read_classic_netcdf(bytes);
    return fail(ErrorCode::unsupported, "is neither an HDF5 nor a netCDF file");
}

Result<Elements> read_array(std::span<const std::byte> bytes, const Array& array,
                            std::uint64_t most_bytes) {
    const auto count = array.count();
    if (array.type.size == 0)
        return fail(ErrorCode::unsupported,
                    "the array {} is stored in a form of HDF5 that is not read; h5repack --low=0 "
                    "--high=1 rewrites the file",
                    array.name);
    if (!count || *count > most_bytes / array.type.size)
        return fail(ErrorCode::unsupported, "the array {} takes more than {} bytes", array.name,
                    most_bytes);
    std::vector<std::byte> elements(static_cast<std::size_t>(*count) * array.type.size);
    if (Status stored = copy_elements(bytes, array, elements); !stored) return pass_on(stored);
    return Elements{std::move(elements), array.type};
}

}  // namespace stormcellar::arrayfile
