// tests/export/netcdf_reader.h -- reads a netCDF or HDF5 file, or one group of it; a missing item
// fails the test.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netcdf.h>

namespace stormcellar::netcdf {

class Reader {
  public:
    explicit Reader(const std::filesystem::path& path) {
        EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &root_), NC_NOERR);
        id_ = root_;
    }
    Reader(const std::filesystem::path& path, const std::string& group) : Reader(path) {
        EXPECT_EQ(nc_inq_grp_full_ncid(root_, ("/" + group).c_str(), &id_), NC_NOERR) << group;
    }
    ~Reader() { nc_close(root_); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    // Reads values as they are stored, without applying scale_factor and add_offset.
    std::vector<double> values(const char* name, std::size_t count) {
        std::vector<double> read(count);
        EXPECT_EQ(nc_get_var_double(id_, variable(name), read.data()), NC_NOERR) << name;
        return read;
    }
    std::string letters(const char* name, std::size_t count) {
        std::string read(count, '\0');
        EXPECT_EQ(nc_get_var_text(id_, variable(name), read.data()), NC_NOERR) << name;
        return read;
    }
    // Reads a single string (NC_STRING).
    std::string string(const char* name) {
        char* read = nullptr;
        EXPECT_EQ(nc_get_var_string(id_, variable(name), &read), NC_NOERR) << name;
        const std::string found = read == nullptr ? "" : read;
        nc_free_string(1, &read);
        return found;
    }
    bool has_group(const char* name) {
        int found = -1;
        return nc_inq_grp_ncid(id_, name, &found) == NC_NOERR;
    }
    // Returns an attribute of a variable, or of the file if `of` is null.
    std::string text(const char* of, const char* name) {
        const int owner = of == nullptr ? NC_GLOBAL : variable(of);
        std::size_t length = 0;
        EXPECT_EQ(nc_inq_attlen(id_, owner, name, &length), NC_NOERR) << name;
        std::string read(length, '\0');
        EXPECT_EQ(nc_get_att_text(id_, owner, name, read.data()), NC_NOERR) << name;
        return read;
    }
    double number(const char* of, const char* name) {
        const int owner = of == nullptr ? NC_GLOBAL : variable(of);
        double read = 0;
        EXPECT_EQ(nc_get_att_double(id_, owner, name, &read), NC_NOERR) << name;
        return read;
    }
    // Returns an attribute that has several numbers.
    std::vector<double> numbers(const char* of, const char* name) {
        const int owner = of == nullptr ? NC_GLOBAL : variable(of);
        std::size_t length = 0;
        EXPECT_EQ(nc_inq_attlen(id_, owner, name, &length), NC_NOERR) << name;
        std::vector<double> read(length);
        EXPECT_EQ(nc_get_att_double(id_, owner, name, read.data()), NC_NOERR) << name;
        return read;
    }
    std::size_t length(const char* dimension) {
        int found = -1;
        std::size_t length = 0;
        EXPECT_EQ(nc_inq_dimid(id_, dimension, &found), NC_NOERR) << dimension;
        EXPECT_EQ(nc_inq_dimlen(id_, found, &length), NC_NOERR) << dimension;
        return length;
    }
    bool is_unlimited(const char* dimension) {
        int wanted = -1;
        int unlimited = -1;
        EXPECT_EQ(nc_inq_dimid(id_, dimension, &wanted), NC_NOERR) << dimension;
        EXPECT_EQ(nc_inq_unlimdim(id_, &unlimited), NC_NOERR);
        return unlimited == wanted;
    }
    bool has_variable(const char* name) {
        int found = -1;
        return nc_inq_varid(id_, name, &found) == NC_NOERR;
    }
    bool has_attribute(const char* of, const char* name) {
        const int owner = of == nullptr ? NC_GLOBAL : variable(of);
        return nc_inq_att(id_, owner, name, nullptr, nullptr) == NC_NOERR;
    }

  private:
    int variable(const char* name) {
        int found = -1;
        EXPECT_EQ(nc_inq_varid(id_, name, &found), NC_NOERR) << name;
        return found;
    }
    int root_ = 0;
    int id_ = 0;  // of the root or the group
};

}  // namespace stormcellar::netcdf
