// tests/level2/foreign/hdf5_writer.h -- writes HDF5 files in memory as programs of other countries
// do: texts of fixed and varying length, numbers of several types, and packed data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>

namespace stormcellar::testing {

class Hdf5Writer {
  public:
    // `newest` is the newest form of the library that the file may have.
    explicit Hdf5Writer(H5F_libver_t newest = H5F_LIBVER_V18) {
        const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
        H5Pset_fapl_core(access, 4096, 0);
        H5Pset_libver_bounds(access, newest == H5F_LIBVER_V18 ? H5F_LIBVER_EARLIEST : newest,
                             newest);
        file_ = H5Fcreate("memory.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access);
        H5Pclose(access);
        group_ = H5Gopen2(file_, "/", H5P_DEFAULT);
        EXPECT_GE(group_, 0);
    }
    ~Hdf5Writer() { close(); }
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    // Opens a group, such as "dataset1/what", and makes it if there is none. Attributes and data
    // then belong to it.
    Hdf5Writer& group(const std::string& path) {
        H5Gclose(group_);
        const hid_t links = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(links, 1);
        group_ = exists(path) ? H5Gopen2(file_, path.c_str(), H5P_DEFAULT)
                              : H5Gcreate2(file_, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT);
        H5Pclose(links);
        EXPECT_GE(group_, 0) << path;
        return *this;
    }
    Hdf5Writer& text(const char* name, const std::string& value) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, value.size() + 1);
        attribute(name, type, H5Screate(H5S_SCALAR), value.c_str());
        H5Tclose(type);
        return *this;
    }
    Hdf5Writer& varying_text(const char* name, const std::string& value) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        const char* pointer = value.c_str();
        attribute(name, type, H5Screate(H5S_SCALAR), &pointer);
        H5Tclose(type);
        return *this;
    }
    template <class Number>
    Hdf5Writer& number(const char* name, Number value) {
        attribute(name, type_of<Number>(), H5Screate(H5S_SCALAR), &value);
        return *this;
    }
    Hdf5Writer& numbers(const char* name, const std::vector<double>& values) {
        const hsize_t size = values.size();
        attribute(name, H5T_NATIVE_DOUBLE, H5Screate_simple(1, &size, nullptr), values.data());
        return *this;
    }
    // Writes an array of rows. With `chunk_rows`, packs chunks of that many rows.
    template <class Number>
    Hdf5Writer& data(const char* name, std::size_t rows, const std::vector<Number>& values,
                     std::size_t chunk_rows = 0) {
        const hsize_t shape[] = {rows, values.size() / rows};
        const hsize_t chunk[] = {chunk_rows, shape[1]};
        const hid_t space = H5Screate_simple(2, shape, nullptr);
        const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
        if (chunk_rows > 0) {
            H5Pset_chunk(layout, 2, chunk);
            H5Pset_shuffle(layout);
            H5Pset_deflate(layout, 6);
            H5Pset_fletcher32(layout);
        }
        const hid_t set =
            H5Dcreate2(group_, name, type_of<Number>(), space, H5P_DEFAULT, layout, H5P_DEFAULT);
        EXPECT_GE(H5Dwrite(set, type_of<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                  0);
        H5Dclose(set);
        H5Pclose(layout);
        H5Sclose(space);
        return *this;
    }
    // Makes a link to the root, so that the root contains itself.
    void link_to_root(const char* name) {
        EXPECT_GE(H5Lcreate_hard(file_, "/", group_, name, H5P_DEFAULT, H5P_DEFAULT), 0);
    }

    std::vector<std::byte> bytes() {
        H5Fflush(file_, H5F_SCOPE_GLOBAL);
        const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
        std::vector<std::byte> made(size > 0 ? static_cast<std::size_t>(size) : 0);
        H5Fget_file_image(file_, made.data(), made.size());
        return made;
    }

  private:
    template <class Number>
    static hid_t type_of() {
        if constexpr (std::is_same_v<Number, double>) return H5T_NATIVE_DOUBLE;
        if constexpr (std::is_same_v<Number, float>) return H5T_NATIVE_FLOAT;
        if constexpr (std::is_same_v<Number, int>) return H5T_NATIVE_INT;
        if constexpr (std::is_same_v<Number, std::int64_t>) return H5T_NATIVE_INT64;
        if constexpr (std::is_same_v<Number, std::uint8_t>) return H5T_NATIVE_UINT8;
        if constexpr (std::is_same_v<Number, std::uint16_t>) return H5T_NATIVE_UINT16;
        if constexpr (std::is_same_v<Number, std::int16_t>) return H5T_STD_I16BE;
    }
    void attribute(const char* name, hid_t type, hid_t space, const void* value) {
        const hid_t made = H5Acreate2(group_, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(H5Awrite(made, type, value), 0) << name;
        H5Aclose(made);
        H5Sclose(space);
    }
    bool exists(const std::string& path) const {
        for (std::size_t at = 0; at != std::string::npos;) {
            at = path.find('/', at + 1);
            if (H5Lexists(file_, path.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
        }
        return true;
    }
    void close() {
        H5Gclose(group_);
        H5Fclose(file_);
    }

    hid_t file_ = -1;
    hid_t group_ = -1;
};

}  // namespace stormcellar::testing
