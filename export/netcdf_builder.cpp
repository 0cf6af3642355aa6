#include "export/netcdf_builder.h"

#include <array>
#include <cstdlib>

#include <netcdf.h>
#include <netcdf_mem.h>

namespace stormcellar::netcdf {

static_assert(NetcdfBuilder::file == NC_GLOBAL);

Mutex& library_mutex() {
    static Mutex mutex;
    return mutex;
}

NetcdfBuilder::NetcdfBuilder() {
    // The file exists in memory only, so its name does not matter.
    open_ = good(nc_create_mem("memory.nc", NC_NETCDF4 | NC_CLOBBER, 0, &root_), "begin");
    id_ = root_;
}

NetcdfBuilder::~NetcdfBuilder() {
    if (open_) nc_abort(root_);
}

bool NetcdfBuilder::good(int code, const char* doing) {
    if (failure_ == NC_NOERR && code != NC_NOERR) {
        failure_ = code;
        failed_doing_ = doing;
    }
    return failure_ == NC_NOERR;
}

void NetcdfBuilder::group(const char* name) {
    if (failure_ == NC_NOERR) good(nc_def_grp(root_, name, &id_), name);
}

int NetcdfBuilder::dimension(const char* name, std::size_t size) {
    int id = -1;
    if (failure_ == NC_NOERR) good(nc_def_dim(id_, name, size, &id), name);
    return id;
}

int NetcdfBuilder::variable(const char* name, int type, const std::vector<int>& dimensions) {
    int id = -1;
    if (failure_ == NC_NOERR) {
        good(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(),
                        &id),
             name);
    }
    return id;
}

void NetcdfBuilder::chunks(int variable, const std::vector<std::size_t>& sizes) {
    if (failure_ != NC_NOERR) return;
    good(nc_def_var_chunking(id_, variable, NC_CHUNKED, sizes.data()), "chunks");
}

void NetcdfBuilder::chunk_cache(int variable, std::size_t bytes) {
    if (failure_ != NC_NOERR) return;
    constexpr std::size_t slots = 101;       // number of slots of the hash table
    constexpr float written_go_first = 1.0;  // evict full chunks first; they are not needed again
    good(nc_set_var_chunk_cache(id_, variable, bytes, slots, written_go_first), "chunk cache");
}

void NetcdfBuilder::deflate(int variable, int level) {
    if (failure_ != NC_NOERR || level == 0) return;
    constexpr int shuffle = 1;
    good(nc_def_var_deflate(id_, variable, shuffle, 1, level), "deflate");
}

void NetcdfBuilder::fill_value(int variable, double value) {
    nc_type type = NC_NAT;
    if (failure_ != NC_NOERR || !good(nc_inq_vartype(id_, variable, &type), "fill value")) return;
    const auto define = [&](auto typed) {
        good(nc_def_var_fill(id_, variable, NC_FILL, &typed), "fill value");
    };
    switch (type) {
        case NC_BYTE:
            return define(static_cast<signed char>(value));
        case NC_SHORT:
            return define(static_cast<short>(value));
        case NC_INT:
            return define(static_cast<int>(value));
        case NC_FLOAT:
            return define(static_cast<float>(value));
        case NC_DOUBLE:
            return define(value);
        default:
            good(NC_EBADTYPE, "fill value");
    }
}

void NetcdfBuilder::text(int variable, const char* name, std::string_view value) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_att_text(id_, variable, name, value.size(), value.data()), name);
}

void NetcdfBuilder::number(int variable, const char* name, double value) {
    numbers(variable, name, std::span(&value, 1));
}

void NetcdfBuilder::number(int variable, const char* name, int value) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_att_int(id_, variable, name, NC_INT, 1, &value), name);
}

void NetcdfBuilder::numbers(int variable, const char* name, std::span<const double> values) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_att_double(id_, variable, name, NC_DOUBLE, values.size(), values.data()), name);
}

void NetcdfBuilder::bytes(int variable, const char* name, std::span<const signed char> values) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_att_schar(id_, variable, name, NC_BYTE, values.size(), values.data()), name);
}

template <class Value>
void NetcdfBuilder::write_by(int (*put)(int, int, const Value*), int variable,
                             std::span<const Value> values) {
    if (failure_ != NC_NOERR || values.empty()) return;
    good(put(id_, variable, values.data()), "write");
}

void NetcdfBuilder::write(int variable, std::span<const double> values) {
    write_by(nc_put_var_double, variable, values);
}
void NetcdfBuilder::write(int variable, std::span<const float> values) {
    write_by(nc_put_var_float, variable, values);
}
void NetcdfBuilder::write(int variable, std::span<const int> values) {
    write_by(nc_put_var_int, variable, values);
}
void NetcdfBuilder::write(int variable, std::span<const signed char> values) {
    write_by(nc_put_var_schar, variable, values);
}
void NetcdfBuilder::write(int variable, std::span<const char> characters) {
    write_by(nc_put_var_text, variable, characters);
}

void NetcdfBuilder::write(int variable, std::span<const std::string> values) {
    std::vector<const char*> strings;
    for (const std::string& value : values)
        strings.push_back(value.c_str());
    if (failure_ != NC_NOERR || strings.empty()) return;
    good(nc_put_var_string(id_, variable, strings.data()), "write");
}

void NetcdfBuilder::write_first(int variable, double value) {
    if (failure_ != NC_NOERR) return;
    const std::size_t first = 0;
    good(nc_put_var1_double(id_, variable, &first, &value), "write");
}

template <class Value>
void NetcdfBuilder::write_rows_by(int (*put)(int, int, const std::size_t*, const std::size_t*,
                                             const Value*),
                                  int variable, const Rows& rows, std::span<const Value> values) {
    if (failure_ != NC_NOERR || values.empty()) return;
    const std::array<std::size_t, 2> start = {rows.first, 0};
    const std::array<std::size_t, 2> count = {rows.count, rows.width};
    const bool fits = values.size() == rows.count * rows.width;
    good(fits ? put(id_, variable, start.data(), count.data(), values.data()) : NC_EINVAL,
         "write rows");
}

void NetcdfBuilder::write_rows(int variable, const Rows& rows, std::span<const int> values) {
    write_rows_by(nc_put_vara_int, variable, rows, values);
}
void NetcdfBuilder::write_rows(int variable, const Rows& rows,
                               std::span<const signed char> values) {
    write_rows_by(nc_put_vara_schar, variable, rows, values);
}

Result<std::vector<std::byte>> NetcdfBuilder::finish() {
    NC_memio memory{};
    if (failure_ == NC_NOERR) {
        good(nc_close_memio(root_, &memory), "close");
        open_ = false;
    }
    if (failure_ != NC_NOERR) {
        return fail(ErrorCode::internal, "netCDF: {}: {}", failed_doing_, nc_strerror(failure_));
    }
    const auto* first = static_cast<const std::byte*>(memory.memory);
    std::vector<std::byte> bytes(first, first + memory.size);
    std::free(memory.memory);  // the caller of the library must free its buffer
    return bytes;
}

}  // namespace stormcellar::netcdf
