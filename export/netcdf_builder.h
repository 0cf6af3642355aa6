// export/netcdf_builder.h -- builds a netCDF-4 file in memory; internal to export.
//
// The builder keeps the first failure: later calls do nothing, and finish() returns that failure.
// So a writer may describe the whole file and check only the result of finish().
//
// Threads   The netCDF library is not thread-safe, so hold library_mutex() while a builder lives.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"

namespace stormcellar::netcdf {

[[nodiscard]] Mutex& library_mutex();

class NetcdfBuilder {
  public:
    NetcdfBuilder() STORMCELLAR_REQUIRES(library_mutex());
    NetcdfBuilder(const NetcdfBuilder&) = delete;
    NetcdfBuilder& operator=(const NetcdfBuilder&) = delete;
    ~NetcdfBuilder();

    // The number that means the file itself; its attributes are the global attributes. As the
    // number of a variable, it means "no variable".
    static constexpr int file = -1;

    // Makes a group in the root of the file. From then on the builder writes into this group:
    // `file` then means the group, and only its own variables can be written. Variables of
    // the group can use dimensions of the root.
    void group(const char* name);

    // Makes a dimension. As in netCDF, a size of 0 makes an unlimited dimension, which is empty at
    // first.
    int dimension(const char* name, std::size_t size);
    // Makes a variable. `type` is a type of netcdf.h. A variable without dimensions is a scalar.
    int variable(const char* name, int type, const std::vector<int>& dimensions);
    void chunks(int variable, const std::vector<std::size_t>& sizes);
    // Sets how many bytes of a chunked variable stay unpacked in memory. The default of netCDF is
    // 16 MiB or more.
    void chunk_cache(int variable, std::size_t bytes);
    void deflate(int variable, int level);
    // Sets the fill value. It is converted to the type of the variable.
    void fill_value(int variable, double value);
    void text(int variable, const char* name, std::string_view value);
    void number(int variable, const char* name, double value);
    void number(int variable, const char* name, int value);
    void numbers(int variable, const char* name, std::span<const double> values);
    void bytes(int variable, const char* name, std::span<const signed char> values);

    // Writes a whole variable. netCDF converts the numbers to the type of the variable. Does
    // nothing if there are no values.
    void write(int variable, std::span<const double> values);
    void write(int variable, std::span<const float> values);
    void write(int variable, std::span<const int> values);
    void write(int variable, std::span<const signed char> values);
    // Writes a variable of characters. `characters` has its rows, which are equally long, one after
    // the other.
    void write(int variable, std::span<const char> characters);

    // Writes a variable of strings (type NC_STRING).
    void write(int variable, std::span<const std::string> values);

    // Writes element 0 of a variable on an unlimited dimension. The dimension then has the length
    // 1, as write() needs for the other variables.
    void write_first(int variable, double value);

    // Rows of a variable with two dimensions. Each row covers the whole second dimension.
    struct Rows {
        std::size_t first = 0;
        std::size_t count = 0;
        std::size_t width = 0;
    };
    void write_rows(int variable, const Rows& rows, std::span<const int> values);
    void write_rows(int variable, const Rows& rows, std::span<const signed char> values);

    // Returns the bytes of the file, and closes the builder.
    Result<std::vector<std::byte>> finish();

  private:
    bool good(int code, const char* doing);
    template <class Value>
    void write_by(int (*put)(int, int, const Value*), int variable, std::span<const Value> values);
    template <class Value>
    void write_rows_by(int (*put)(int, int, const std::size_t*, const std::size_t*, const Value*),
                       int variable, const Rows& rows, std::span<const Value> values);

    int root_ = -1;
    int id_ = -1;  // of the root or the current group
    bool open_ = false;
    int failure_ = 0;
    std::string failed_doing_;
};

}  // namespace stormcellar::netcdf
