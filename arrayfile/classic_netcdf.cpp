#include "arrayfile/classic_netcdf.h"

#include <algorithm>

namespace stormcellar::arrayfile {
namespace {

constexpr std::uint32_t dimension_tag = 0x0A;
constexpr std::uint32_t variable_tag = 0x0B;
constexpr std::uint32_t attribute_tag = 0x0C;

std::optional<ElementType> element_type(std::uint64_t number) {
    using enum ElementKind;
    switch (number) {
        case 1:
            return ElementType{signed_integer, 1, true};
        case 2:
            return ElementType{text, 1, true};
        case 3:
            return ElementType{signed_integer, 2, true};
        case 4:
            return ElementType{signed_integer, 4, true};
        case 5:
            return ElementType{floating, 4, true};
        case 6:
            return ElementType{floating, 8, true};
        case 7:
            return ElementType{unsigned_integer, 1, true};
        case 8:
            return ElementType{unsigned_integer, 2, true};
        case 9:
            return ElementType{unsigned_integer, 4, true};
        case 10:
            return ElementType{signed_integer, 8, true};
        case 11:
            return ElementType{unsigned_integer, 8, true};
        default:
            return std::nullopt;
    }
}

// Reads the header. A read past the end, or anything that contradicts the format, sets bad().
class Header {
  public:
    explicit Header(std::span<const std::byte> bytes)
        : bytes_(bytes), version_(std::to_integer<int>(bytes[3])) {}

    [[nodiscard]] bool bad() const { return bad_; }
    Group read();

  private:
    std::span<const std::byte> take(std::uint64_t count) {
        if (bad_ || count > bytes_.size() - at_) {
            bad_ = true;
            return {};
        }
        const auto part = bytes_.subspan(at_, static_cast<std::size_t>(count));
        at_ += part.size();
        return part;
    }
    std::uint64_t number(std::size_t width) {
        std::uint64_t value = 0;
        for (const std::byte one : take(width))
            value = (value << 8) | std::to_integer<std::uint64_t>(one);
        return value;
    }
    std::uint64_t size() { return number(version_ == 5 ? 8 : 4); }
    std::uint64_t address() { return number(version_ == 1 ? 4 : 8); }
    std::string name() {
        const std::uint64_t length = size();
        const auto letters = take(length);
        take((4 - length % 4) % 4);
        return {reinterpret_cast<const char*>(letters.data()), letters.size()};
    }
    // Returns the number of elements of a list with this tag. Each element takes at least 8 bytes.
    std::uint64_t begin_list(std::uint32_t tag) {
        const std::uint64_t found = number(4), count = size();
        if ((found != tag && (found != 0 || count != 0)) || count > bytes_.size() / 8) bad_ = true;
        return bad_ ? 0 : count;
    }
    Attributes attributes();
    void variable(Group& group);

    struct Dimension {
        std::string name;
        std::uint64_t size = 0;  // 0: the records
    };
    std::span<const std::byte> bytes_;
    int version_;
    std::size_t at_ = 4;
    bool bad_ = false;
    std::uint64_t records_ = 0;
    std::vector<Dimension> dimensions_;
};

Attributes Header::attributes() {
    Attributes made;
    const std::uint64_t count = begin_list(attribute_tag);
    for (std::uint64_t i = 0; i < count && !bad_; ++i) {
        std::string called = name();
        const auto type = element_type(number(4));
        const std::uint64_t elements = size();
        if (!type || elements > bytes_.size()) bad_ = true;
        if (bad_) break;
        const std::uint64_t length = elements * type->size;
        const auto data = take(length);
        take((4 - length % 4) % 4);
        Value value;
        value.is_text = type->kind == ElementKind::text;
        if (value.is_text) {
            const std::string_view text{reinterpret_cast<const char*>(data.data()), data.size()};
            value.text = std::string{text.substr(0, text.find('\0'))};
        }
        for (std::size_t at = 0; !value.is_text && at < data.size(); at += type->size)
            value.numbers.push_back(number_at(data.data() + at, *type));
        made.all.emplace_back(std::move(called), std::move(value));
    }
    return made;
}

void Header::variable(Group& group) {
    Array array;
    array.name = name();
    const std::uint64_t rank = size();
    if (rank > 32) bad_ = true;
    for (std::uint64_t i = 0; i < rank && !bad_; ++i) {
        const std::uint64_t dimension = size();
        if (dimension >= dimensions_.size()) {
            bad_ = true;
            return;
        }
        const Dimension& one = dimensions_[static_cast<std::size_t>(dimension)];
        const bool is_record = one.size == 0;
        if (is_record && i == 0) array.storage.kind = Storage::Kind::records;
        array.dimensions.push_back(one.name);
        array.shape.push_back(is_record ? records_ : one.size);
    }
    array.attributes = attributes();
    const auto type = element_type(number(4));
    size();  // the size, which is wrong for large variables; the shape tells the size
    array.storage.address = address();
    if (!type) bad_ = true;
    if (bad_) return;
    array.type = *type;
    if (array.storage.kind == Storage::Kind::none) array.storage.kind = Storage::Kind::contiguous;
    array.storage.size_bytes = array.count().value_or(0) * type->size;
    group.arrays.push_back(std::move(array));
}

// Sets the distance of records: the bytes of all variables of one record, each filled to a multiple
// of four bytes unless there is only one variable.
void set_record_bytes(Group& group, std::uint64_t records) {
    std::uint64_t sum = 0, only = 0;
    std::size_t variables = 0;
    for (const Array& array : group.arrays) {
        if (array.storage.kind != Storage::Kind::records || records == 0) continue;
        only = array.storage.size_bytes / records;
        sum += only + (4 - only % 4) % 4;
        ++variables;
    }
    for (Array& array : group.arrays)
        array.storage.record_bytes = variables == 1 ? only : sum;
}

Group Header::read() {
    Group group;
    records_ = size();
    // A writer that was broken off leaves all bits set.
    if (records_ == (version_ == 5 ? ~std::uint64_t{0} : 0xFFFFFFFFU)) records_ = 0;
    const std::uint64_t count = begin_list(dimension_tag);
    for (std::uint64_t i = 0; i < count && !bad_; ++i) {
        std::string called = name();
        dimensions_.push_back({std::move(called), size()});
    }
    group.attributes = attributes();
    const std::uint64_t variables = begin_list(variable_tag);
    for (std::uint64_t i = 0; i < variables && !bad_ && i < most_objects; ++i)
        variable(group);
    set_record_bytes(group, records_);
    return group;
}

}  // namespace

Result<Group> read_classic_netcdf(std::span<const std::byte> bytes) {
    Header header{bytes};
    Group group = header.read();
    if (header.bad()) return fail(ErrorCode::corrupt, "the header of the netCDF file is damaged");
    return group;
}

}  // namespace stormcellar::arrayfile
