// tests/level2/foreign/netcdf_writer.h -- writes netCDF files, classic or netCDF-4.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <netcdf.h>

#include "stormcellar/base/file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {

class NetcdfWriter {
  public:
    // `mode` is the mode of nc_create(): NC_NETCDF4, NC_CLASSIC_MODEL, NC_64BIT_OFFSET, ....
    explicit NetcdfWriter(int mode) {
        EXPECT_EQ(nc_create(path_.c_str(), mode | NC_CLOBBER, &file_), NC_NOERR);
        group_ = file_;
    }
    NetcdfWriter(const NetcdfWriter&) = delete;
    NetcdfWriter& operator=(const NetcdfWriter&) = delete;

    void group(const char* name) { EXPECT_EQ(nc_def_grp(file_, name, &group_), NC_NOERR); }
    void dimension(const char* name, std::size_t size) {
        int id = 0;
        EXPECT_EQ(nc_def_dim(group_, name, size, &id), NC_NOERR) << name;
    }
    // Writes an attribute of the array `of`, or of the group if `of` is empty.
    void text(const std::string& of, const char* name, const std::string& value) {
        define();
        EXPECT_EQ(nc_put_att_text(group_, id_of(of), name, value.size(), value.c_str()), NC_NOERR);
    }
    void number(const std::string& of, const char* name, int type, double value) {
        define();
        EXPECT_EQ(nc_put_att_double(group_, id_of(of), name, type, 1, &value), NC_NOERR);
    }
    // Writes an array with these dimensions, and with a fill value if one is given.
    template <class Number>
    void array(const std::string& name, const std::vector<std::string>& dimensions,
               const std::vector<Number>& values,
               std::optional<std::type_identity_t<Number>> fill = std::nullopt) {
        define();
        std::vector<int> ids;
        std::vector<std::size_t> counts;
        for (const std::string& dimension : dimensions) {
            int id = 0;
            EXPECT_EQ(nc_inq_dimid(group_, dimension.c_str(), &id), NC_NOERR) << dimension;
            ids.push_back(id);
            std::size_t size = 0;
            nc_inq_dimlen(group_, id, &size);
            counts.push_back(size);
        }
        int id = 0;
        EXPECT_EQ(nc_def_var(group_, name.c_str(), type_of<Number>(), static_cast<int>(ids.size()),
                             ids.data(), &id),
                  NC_NOERR)
            << name;
        if (fill) nc_put_att(group_, id, "_FillValue", type_of<Number>(), 1, &*fill);
        nc_enddef(file_);
        if (!counts.empty() && counts[0] == 0) counts[0] = values.size();  // records
        for (std::size_t i = 1; i < counts.size() && counts[0] == values.size(); ++i)
            counts[0] /= counts[i];
        const std::vector<std::size_t> starts(counts.size(), 0);
        EXPECT_EQ(nc_put_vara(group_, id, starts.data(), counts.data(), values.data()), NC_NOERR)
            << name;
    }
    std::vector<std::byte> bytes() {
        EXPECT_EQ(nc_close(file_), NC_NOERR);
        return read_file(path_).value_or(std::vector<std::byte>{});
    }

  private:
    void define() { nc_redef(file_); }
    [[nodiscard]] int id_of(const std::string& name) const {
        int id = NC_GLOBAL;
        if (name.empty()) return id;
        EXPECT_EQ(nc_inq_varid(group_, name.c_str(), &id), NC_NOERR) << name;
        return id;
    }
    template <class Number>
    static int type_of() {
        if constexpr (std::is_same_v<Number, double>) return NC_DOUBLE;
        if constexpr (std::is_same_v<Number, float>) return NC_FLOAT;
        if constexpr (std::is_same_v<Number, int>) return NC_INT;
        if constexpr (std::is_same_v<Number, short>) return NC_SHORT;
        if constexpr (std::is_same_v<Number, char>) return NC_CHAR;
    }

    TemporaryDirectory directory_;
    const std::filesystem::path path_ = directory_.path() / "file.nc";
    int file_ = 0;
    int group_ = 0;
};

}  // namespace stormcellar::testing
