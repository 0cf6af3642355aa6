#include "export/netcdf_builder.h"

#include <array>
#include <string>
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

TEST(NetcdfBuilder, TheFirstFailureSticksAndIsNamed) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    builder.dimension("x", 3);
    builder.dimension("x", 4);  // a name in use
    builder.number(NetcdfBuilder::file, "answer", 42);
    const auto bytes = builder.finish();
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::internal);
    EXPECT_NE(bytes.error().message.find("x: "), std::string::npos) << bytes.error().message;
}

TEST(NetcdfBuilder, AnUnfinishedFileIsDropped) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder builder;
    builder.dimension("x", 3);
}

}  // namespace
}  // namespace stormcellar::netcdf
