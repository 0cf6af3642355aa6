#include "export/netcdf_builder.h"

#include <cstdlib>

#include <netcdf.h>
#include <netcdf_mem.h>

namespace stormcellar::netcdf {

static_assert(NetcdfBuilder::file == NC_GLOBAL);

std::mutex& library_mutex() {
    static std::mutex mutex;
    return mutex;
}

NetcdfBuilder::NetcdfBuilder() {
    // The name is never used: the file exists in memory only.
    open_ = good(nc_create_mem("grid.nc", NC_NETCDF4 | NC_CLOBBER, 0, &id_), "begin");
}

NetcdfBuilder::~NetcdfBuilder() {
    if (open_) nc_abort(id_);
}

bool NetcdfBuilder::good(int code, const char* doing) {
    if (failure_ == NC_NOERR && code != NC_NOERR) {
        failure_ = code;
        failed_doing_ = doing;
    }
    return failure_ == NC_NOERR;
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

void NetcdfBuilder::deflate(int variable, int level) {
    if (failure_ != NC_NOERR || level == 0) return;
    constexpr int shuffle = 1;
    good(nc_def_var_deflate(id_, variable, shuffle, 1, level), "deflate");
}

void NetcdfBuilder::fill_value(int variable, float value) {
    if (failure_ != NC_NOERR) return;
    good(nc_def_var_fill(id_, variable, NC_FILL, &value), "fill value");
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

void NetcdfBuilder::write(int variable, std::span<const double> values) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_var_double(id_, variable, values.data()), "write");
}

void NetcdfBuilder::write(int variable, std::span<const float> values) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_var_float(id_, variable, values.data()), "write");
}

void NetcdfBuilder::write(int variable, std::span<const signed char> values) {
    if (failure_ != NC_NOERR) return;
    good(nc_put_var_schar(id_, variable, values.data()), "write");
}

Result<std::vector<std::byte>> NetcdfBuilder::finish() {
    NC_memio memory{};
    if (failure_ == NC_NOERR) {
        good(nc_close_memio(id_, &memory), "close");
        open_ = false;
    }
    if (failure_ != NC_NOERR) {
        return fail(ErrorCode::internal, "netCDF: {}: {}", failed_doing_, nc_strerror(failure_));
    }
    const auto* first = static_cast<const std::byte*>(memory.memory);
    std::vector<std::byte> bytes(first, first + memory.size);
    std::free(memory.memory);  // the library gives its buffer away
    return bytes;
}

}  // namespace stormcellar::netcdf
