// export/netcdf_builder.h -- builds a netCDF-4 file in memory; internal to export.
//
// The builder keeps the first failure: later calls do nothing, and finish() returns the failure. So
// a writer may describe the whole file and check only the result of finish().
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

    // A number for the file itself, whose attributes are the global ones. It also means "no
    // variable".
    static constexpr int file = -1;

    // Makes a dimension. A size of 0 makes an unlimited dimension with nothing in it yet, as in
    // netCDF.
    int dimension(const char* name, std::size_t size);
    // Makes a variable. Types are those of netcdf.h. A variable without dimensions is a scalar.
    int variable(const char* name, int type, const std::vector<int>& dimensions);
    void chunks(int variable, const std::vector<std::size_t>& sizes);
    // Sets how many bytes of a chunked variable stay unpacked in memory; by default netCDF keeps 16
    // MiB or more.
    void chunk_cache(int variable, std::size_t bytes);
    void deflate(int variable, int level);
    // Sets the fill value, in the type of the variable.
    void fill_value(int variable, double value);
    void text(int variable, const char* name, std::string_view value);
    void number(int variable, const char* name, double value);
    void number(int variable, const char* name, int value);
    void numbers(int variable, const char* name, std::span<const double> values);
    void bytes(int variable, const char* name, std::span<const signed char> values);

    // Writes a whole variable; netCDF converts the numbers to its type. Does nothing without
    // values.
    void write(int variable, std::span<const double> values);
    void write(int variable, std::span<const float> values);
    void write(int variable, std::span<const int> values);
    void write(int variable, std::span<const signed char> values);
    // Writes rows of equal length, one after the other, as a variable of characters.
    void write(int variable, std::span<const char> characters);

    // Writes element 0 of a variable on an unlimited dimension; the dimension then has the length
    // 1, which write() needs for the other variables.
    void write_first(int variable, double value);

    // Some rows of a variable with two dimensions, each over the whole second dimension.
    struct Rows {
        std::size_t first = 0;
        std::size_t count = 0;
        std::size_t width = 0;
    };
    void write_rows(int variable, const Rows& rows, std::span<const int> values);
    void write_rows(int variable, const Rows& rows, std::span<const signed char> values);

    // Returns the bytes of the file. The builder is then closed.
    Result<std::vector<std::byte>> finish();

  private:
    bool good(int code, const char* doing);
    template <class Value>
    void write_by(int (*put)(int, int, const Value*), int variable, std::span<const Value> values);
    template <class Value>
    void write_rows_by(int (*put)(int, int, const std::size_t*, const std::size_t*, const Value*),
                       int variable, const Rows& rows, std::span<const Value> values);

    int id_ = -1;
    bool open_ = false;
    int failure_ = 0;
    std::string failed_doing_;
};

}  // namespace stormcellar::netcdf
