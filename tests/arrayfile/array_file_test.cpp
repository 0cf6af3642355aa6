#include "arrayfile/array_file.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/level2/foreign/hdf5_writer.h"
#include "tests/level2/foreign/netcdf_writer.h"

namespace stormcellar::arrayfile {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Hdf5Writer;
using testing::NetcdfWriter;

constexpr std::uint64_t most_bytes = 1 << 20;

// A file and its tree. The tree has every group, attribute and array of the test.
struct Tree {
    std::vector<std::byte> bytes;
    Group root;

    explicit Tree(std::vector<std::byte> file) : bytes(std::move(file)) {
        auto read = read_tree(bytes);
        EXPECT_TRUE(read) << read.error().message;
        if (read) root = std::move(*read);
    }
    std::vector<double> values(const Array* array) const {
        std::vector<double> numbers;
        EXPECT_NE(array, nullptr);
        const auto elements =
            array == nullptr ? Result<Elements>{} : read_array(bytes, *array, most_bytes);
        EXPECT_TRUE(elements) << elements.error().message;
        for (std::size_t i = 0; elements && i < elements->size(); ++i)
            numbers.push_back((*elements)[i]);
        return numbers;
    }
};

TEST(ArrayFile, ReadsAttributesOfEachType) {
    Hdf5Writer file;
    file.text("fixed", "some text").varying_text("varying", "other text").varying_text("empty", "");
    file.number("double", 1.5).number("float", -2.25F).number("int", -7);
    file.number("big", std::int16_t{-300}).number("byte", std::uint8_t{200});
    file.numbers("several", {1, 2, 3});
    const Attributes facts = Tree{file.bytes()}.root.attributes;
    EXPECT_EQ(facts.text("fixed"), "some text");
    EXPECT_EQ(facts.text("varying"), "other text");
    EXPECT_EQ(facts.text("empty"), "");
    EXPECT_EQ(facts.number("double"), 1.5);
    EXPECT_EQ(facts.number("float"), -2.25);
    EXPECT_EQ(facts.number("int"), -7);
    EXPECT_EQ(facts.number("byte"), 200);
    EXPECT_THAT(facts.numbers("several"), ElementsAre(1, 2, 3));
    EXPECT_FALSE(facts.number("none"));
    EXPECT_FALSE(facts.text("double"));
}

TEST(ArrayFile, ReadsArraysOfEachLayout) {
    for (const H5F_libver_t newest : {H5F_LIBVER_V18, H5F_LIBVER_V110}) {
        Hdf5Writer file{newest};
        std::vector<double> doubles;
        std::vector<std::uint16_t> words;
        std::vector<std::int16_t> big;
        for (int i = 0; i < 35; ++i) {
            doubles.push_back(i * 0.5);
            words.push_back(static_cast<std::uint16_t>(65535 - i));
        }
        file.group("inner");
        file.data("plain", 5, doubles);
        file.data("packed", 5, words, 2);  // the last chunk reaches beyond the array
        file.data("one_chunk", 5, words, 5);
        const Tree tree{file.bytes()};
        const Group* inner = tree.root.group("inner");
        ASSERT_NE(inner, nullptr);
        EXPECT_THAT(inner->array("plain")->shape, ElementsAre(5, 7));
        EXPECT_EQ(tree.values(inner->array("plain")), doubles);
        const std::vector<double> expected(words.begin(), words.end());
        EXPECT_EQ(tree.values(inner->array("packed")), expected);
        EXPECT_EQ(tree.values(inner->array("one_chunk")), expected);
        const auto limited = read_array(tree.bytes, *inner->array("packed"), 69);
        ASSERT_FALSE(limited);
        EXPECT_THAT(limited.error().message, HasSubstr("packed takes more than 69 bytes"));
    }
}

// The file has so many objects and attributes that it needs every kind of index: nodes of B-trees,
// and blocks of heaps.
TEST(ArrayFile, ReadsManyObjects) {
    for (const H5F_libver_t newest : {H5F_LIBVER_V18, H5F_LIBVER_V110}) {
        Hdf5Writer file{newest};
        for (int i = 0; i < 400; ++i)
            file.group("group" + std::to_string(i)).number("number", i);
        file.group("many");
        for (int i = 0; i < 1500; ++i)
            file.number(("attribute" + std::to_string(i)).c_str(), i);
        file.numbers("huge", std::vector<double>(6000, 2.5));
        const Tree tree{file.bytes()};
        ASSERT_EQ(tree.root.groups.size(), 401U);
        EXPECT_EQ(tree.root.group("group399")->attributes.number("number"), 399);
        const Attributes& facts = tree.root.group("many")->attributes;
        EXPECT_EQ(facts.number("attribute1499"), 1499);
        EXPECT_EQ(facts.numbers("huge"), std::vector<double>(6000, 2.5));
    }
}

TEST(ArrayFile, ReadsEachFormOfNetcdf) {
    for (const int mode : {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4}) {
        for (const std::size_t records : {0U, 3U}) {
            NetcdfWriter file{mode};
            file.text("", "title", "a title");
            file.dimension("time", records);
            file.dimension("range", 2);
            file.array("range", {"range"}, std::vector<double>{10, 20});
            file.array("small", {"time"}, std::vector<short>{1, -2, 3});
            file.array("field", {"time", "range"}, std::vector<float>{1, 2, 3, 4, 5, 6.5F});
            file.text("field", "units", "dBZ");
            file.array("one", {}, std::vector<int>{7});
            const Tree tree{file.bytes()};
            EXPECT_EQ(tree.root.attributes.text("title"), "a title");
            const Array* field = tree.root.array("field");
            ASSERT_NE(field, nullptr);
            EXPECT_THAT(field->shape, ElementsAre(3, 2));
            EXPECT_EQ(field->attributes.text("units"), "dBZ");
            // A netCDF-4 file names a dimension only if an array holds the coordinates of this
            // dimension.
            if (mode != NC_NETCDF4) {
                EXPECT_THAT(field->dimensions, ElementsAre("time", "range"));
            }
            EXPECT_THAT(tree.values(field), ElementsAre(1, 2, 3, 4, 5, 6.5));
            EXPECT_THAT(tree.values(tree.root.array("small")), ElementsAre(1, -2, 3));
            EXPECT_THAT(tree.values(tree.root.array("one")), ElementsAre(7));
        }
    }
}

TEST(ArrayFile, NamesFiltersThatItLacks) {
    Hdf5Writer file;
    file.data("data", 4, std::vector<int>(64, 1), 2);
    Tree tree{file.bytes()};
    Array array = *tree.root.array("data");
    array.storage.filters[0].number = 32001;
    const auto read = read_array(tree.bytes, array, most_bytes);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::unsupported);
    EXPECT_THAT(read.error().message, HasSubstr("filter 32001"));
}

TEST(ArrayFile, RefusesOtherBytes) {
    EXPECT_FALSE(is_hdf5({}));
    EXPECT_FALSE(is_classic_netcdf({}));
    const auto read = read_tree(std::vector<std::byte>(100));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace stormcellar::arrayfile
