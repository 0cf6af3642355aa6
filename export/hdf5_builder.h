// export/hdf5_builder.h -- builds an HDF5 file in memory; internal to export.
//
// The builder keeps the first failure: later calls do nothing, and finish() returns that failure.
// Strings have a fixed length and end with a zero. The file does not contain the time of writing.
//
// Threads   netCDF uses the same library, so hold library_mutex() (export/netcdf_builder.h) while a
//           builder lives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "export/netcdf_builder.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"

namespace stormcellar::netcdf {

// An attribute holds at most 64 KiB, less a few words about it.
inline constexpr std::size_t most_hdf5_numbers = 8100;

class Hdf5Builder {
  public:
    explicit Hdf5Builder(int deflate_level) STORMCELLAR_REQUIRES(library_mutex());
    Hdf5Builder(const Hdf5Builder&) = delete;
    Hdf5Builder& operator=(const Hdf5Builder&) = delete;
    ~Hdf5Builder();

    // Makes a group, such as "dataset1/data1/what", and the groups on the way to it. Attributes
    // then belong to this group. At first they belong to the root.
    void group(const std::string& path);

    // Makes an existing group the current one.
    void open(const std::string& path);

    void text(const char* name, std::string_view value);
    void number(const char* name, double value);
    void integer(const char* name, std::int64_t value);
    // At most most_hdf5_numbers numbers.
    void numbers(const char* name, std::span<const double> values);

    // Writes a dataset of `rows` rows into the current group. Attributes then belong to the
    // dataset.
    void codes(const char* name, std::size_t rows, std::span<const std::uint8_t> values);
    void codes(const char* name, std::size_t rows, std::span<const std::uint16_t> values);

    // Returns the bytes of the file, and closes the builder.
    Result<std::vector<std::byte>> finish();

  private:
    // The library's type of its handles.
    using Handle = std::int64_t;

    bool good(Handle result, const char* doing);
    void close_current();
    void attribute(const char* name, Handle type, Handle space, const void* value);
    void plane(const char* name, Handle type, std::size_t rows, std::size_t size,
               const void* values);

    int deflate_level_;
    Handle file_ = -1;
    Handle current_ = -1;
    bool failed_ = false;
    std::string failed_doing_;
};

}  // namespace stormcellar::netcdf
