#include "export/netcdf_builder.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <netcdf.h>
#include <netcdf_mem.h>

namespace stormcellar::netcdf {
namespace {

TEST(NetcdfBuilder, WhatWasWrittenIsReadBack) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const int x = builder.dimension("x", 3);
    const int values = builder.variable("values", NC_FLOAT, {x});
    builder.chunks(values, {3});
    builder.deflate(values, 1);
    builder.text(values, "units", "m");
    builder.number(NetcdfBuilder::file, "answer", 42);
    builder.write(values, std::array<float, 3>{1, 2, 3});
    const auto bytes = builder.finish();
    ASSERT_TRUE(bytes) << bytes.error().message;

    int id = 0;
    std::vector<std::byte> copy = *bytes;
    ASSERT_EQ(nc_open_mem("in.nc", NC_NOWRITE, copy.size(), copy.data(), &id), NC_NOERR);
    std::array<float, 3> read{};
    int variable = 0;
    int answer = 0;
    EXPECT_EQ(nc_inq_varid(id, "values", &variable), NC_NOERR);
    EXPECT_EQ(nc_get_var_float(id, variable, read.data()), NC_NOERR);
    EXPECT_EQ(nc_get_att_int(id, NC_GLOBAL, "answer", &answer), NC_NOERR);
    nc_close(id);
    EXPECT_EQ(read, (std::array<float, 3>{1, 2, 3}));
    EXPECT_EQ(answer, 42);
}

// Opens the bytes of the builder with the netCDF library.
class Opened {
  public:
    explicit Opened(NetcdfBuilder& builder) {
        auto made = builder.finish();
        EXPECT_TRUE(made) << made.error().message;
        if (made) bytes_ = std::move(*made);
        EXPECT_EQ(nc_open_mem("in.nc", NC_NOWRITE, bytes_.size(), bytes_.data(), &id_), NC_NOERR);
    }
    ~Opened() { nc_close(id_); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    [[nodiscard]] int id() const { return id_; }
    [[nodiscard]] int variable(const char* name) const {
        int found = -1;
        EXPECT_EQ(nc_inq_varid(id_, name, &found), NC_NOERR) << name;
        return found;
    }
    [[nodiscard]] std::vector<double> values(const char* name, std::size_t count) const {
        std::vector<double> read(count);
        EXPECT_EQ(nc_get_var_double(id_, variable(name), read.data()), NC_NOERR) << name;
        return read;
    }

  private:
    std::vector<std::byte> bytes_;
    int id_ = 0;
};

TEST(NetcdfBuilder, RowsLandWhereTheySayAndTheRestIsFill) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const std::vector<int> size = {builder.dimension("row", 3), builder.dimension("column", 2)};
    const int codes = builder.variable("codes", NC_SHORT, size);
    builder.fill_value(codes, -1);
    const int flags = builder.variable("flags", NC_BYTE, size);
    builder.fill_value(flags, -2);
    builder.write_rows(codes, {1, 1, 2}, std::array<int, 2>{7, 65});
    builder.write_rows(flags, {0, 2, 2}, std::array<signed char, 4>{1, 2, 3, 4});
    const Opened file(builder);
    EXPECT_EQ(file.values("codes", 6), (std::vector<double>{-1, -1, 7, 65, -1, -1}));
    EXPECT_EQ(file.values("flags", 6), (std::vector<double>{1, 2, 3, 4, -2, -2}));
}

TEST(NetcdfBuilder, FillValuesAreOfTheVariablesType) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const int x = builder.dimension("x", 1);
    const std::vector<std::pair<const char*, int>> types = {{"byte", NC_BYTE},
                                                            {"short", NC_SHORT},
                                                            {"int", NC_INT},
                                                            {"float", NC_FLOAT},
                                                            {"double", NC_DOUBLE}};
    for (const auto& [name, type] : types)
        builder.fill_value(builder.variable(name, type, {x}), -3);
    const Opened file(builder);
    for (const auto& [name, type] : types)
        EXPECT_EQ(file.values(name, 1), std::vector<double>{-3}) << name;
}

TEST(NetcdfBuilder, RowsThatDoNotFitAreAFailure) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const std::vector<int> size = {builder.dimension("row", 3), builder.dimension("column", 2)};
    const int codes = builder.variable("codes", NC_SHORT, size);
    builder.write_rows(codes, {0, 2, 2}, std::array<int, 3>{1, 2, 3});
    EXPECT_FALSE(builder.finish());
}

TEST(NetcdfBuilder, ADimensionMayHoldNothing) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const int x = builder.variable("x", NC_DOUBLE, {builder.dimension("x", 0)});
    builder.write(x, std::span<const double>{});
    const Opened file(builder);
    std::size_t length = 99;
    EXPECT_EQ(nc_inq_dimlen(file.id(), 0, &length), NC_NOERR);
    EXPECT_EQ(length, 0U);
}

TEST(NetcdfBuilder, CharactersAreReadBack) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    const int words = builder.variable(
        "words", NC_CHAR, {builder.dimension("word", 2), builder.dimension("letter", 3)});
    builder.write(words, std::span<const char>("one2\0\0", 6));
    const Opened file(builder);
    std::string read(6, '?');
    EXPECT_EQ(nc_get_var_text(file.id(), file.variable("words"), read.data()), NC_NOERR);
    EXPECT_EQ(read, std::string("one2\0\0", 6));
}

TEST(NetcdfBuilder, TheFirstFailureSticksAndIsNamed) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    builder.dimension("x", 3);
    builder.dimension("x", 4);  // the name is already used
    builder.number(NetcdfBuilder::file, "answer", 42);
    const auto bytes = builder.finish();
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::internal);
    EXPECT_NE(bytes.error().message.find("x: "), std::string::npos) << bytes.error().message;
}

}  // namespace
}  // namespace stormcellar::netcdf
