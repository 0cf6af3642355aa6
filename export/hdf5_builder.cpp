#include "export/hdf5_builder.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include <hdf5.h>

namespace stormcellar::netcdf {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

// A handle that is closed at the end of its scope.
class Scoped {
  public:
    Scoped(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    Scoped(const Scoped&) = delete;
    Scoped& operator=(const Scoped&) = delete;
    ~Scoped() {
        if (id_ >= 0) close_(id_);
    }
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

// A chunk holds half a sweep of half-degree radials.
constexpr hsize_t most_chunk_rows = 360;
// The file grows in memory by this number of bytes.
constexpr std::size_t growth_bytes = std::size_t{1} << 20;

}  // namespace

Hdf5Builder::Hdf5Builder(int deflate_level) : deflate_level_(deflate_level) {
    // Errors are returned, not printed.
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Scoped access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    constexpr hbool_t on_disk = false;
    if (!good(H5Pset_fapl_core(access, growth_bytes, on_disk), "begin")) return;
    // The file exists in memory only, so its name does not matter.
    file_ = H5Fcreate("memory.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    if (good(file_, "begin")) current_ = H5Gopen2(file_, "/", H5P_DEFAULT);
}

Hdf5Builder::~Hdf5Builder() {
    close_current();
    if (file_ >= 0) H5Fclose(file_);
}

bool Hdf5Builder::good(Handle result, const char* doing) {
    if (!failed_ && result < 0) {
        failed_ = true;
        failed_doing_ = doing;
    }
    return !failed_;
}

void Hdf5Builder::close_current() {
    if (current_ >= 0) H5Oclose(current_);
    current_ = -1;
}

void Hdf5Builder::group(const std::string& path) {
    if (failed_) return;
    close_current();
    const Scoped links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    good(H5Pset_create_intermediate_group(links, 1), path.c_str());
    current_ = H5Gcreate2(file_, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT);
    good(current_, path.c_str());
}

void Hdf5Builder::open(const std::string& path) {
    if (failed_) return;
    close_current();
    current_ = H5Gopen2(file_, path.c_str(), H5P_DEFAULT);
    good(current_, path.c_str());
}

void Hdf5Builder::attribute(const char* name, Handle type, Handle space, const void* value) {
    if (failed_) return;
    const Scoped made(H5Acreate2(current_, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (good(made, name)) good(H5Awrite(made, type, value), name);
}

void Hdf5Builder::text(const char* name, std::string_view value) {
    const std::string ended(value);
    const Scoped type(H5Tcopy(H5T_C_S1), H5Tclose);
    good(H5Tset_size(type, ended.size() + 1), name);
    const Scoped space(H5Screate(H5S_SCALAR), H5Sclose);
    attribute(name, type, space, ended.c_str());
}

void Hdf5Builder::number(const char* name, double value) {
    const Scoped space(H5Screate(H5S_SCALAR), H5Sclose);
    attribute(name, H5T_NATIVE_DOUBLE, space, &value);
}

void Hdf5Builder::integer(const char* name, std::int64_t value) {
    const Scoped space(H5Screate(H5S_SCALAR), H5Sclose);
    attribute(name, H5T_NATIVE_INT64, space, &value);
}

void Hdf5Builder::numbers(const char* name, std::span<const double> values) {
    const hsize_t count = values.size();
    const Scoped space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    attribute(name, H5T_NATIVE_DOUBLE, space, values.data());
}

void Hdf5Builder::plane(const char* name, Handle type, std::size_t rows, std::size_t size,
                        const void* values) {
    if (failed_) return;
    const std::array<hsize_t, 2> sizes{rows, size / rows};
    const Scoped space(H5Screate_simple(2, sizes.data(), nullptr), H5Sclose);
    const Scoped creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    good(H5Pset_obj_track_times(creation, false), name);
    if (deflate_level_ > 0) {
        const std::array<hsize_t, 2> chunk{std::min(sizes[0], most_chunk_rows), sizes[1]};
        good(H5Pset_chunk(creation, 2, chunk.data()), name);
        good(H5Pset_shuffle(creation), name);
        good(H5Pset_deflate(creation, static_cast<unsigned>(deflate_level_)), name);
    }
    const hid_t made = H5Dcreate2(current_, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (!good(made, name)) return;
    close_current();
    current_ = made;
    good(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
}

void Hdf5Builder::codes(const char* name, std::size_t rows, std::span<const std::uint8_t> values) {
    plane(name, H5T_NATIVE_UINT8, rows, values.size(), values.data());
}

void Hdf5Builder::codes(const char* name, std::size_t rows, std::span<const std::uint16_t> values) {
    plane(name, H5T_NATIVE_UINT16, rows, values.size(), values.data());
}

Result<std::vector<std::byte>> Hdf5Builder::finish() {
    close_current();
    std::vector<std::byte> bytes;
    if (!failed_ && good(H5Fflush(file_, H5F_SCOPE_LOCAL), "close")) {
        const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
        if (good(size, "close")) {
            bytes.resize(static_cast<std::size_t>(size));
            good(H5Fget_file_image(file_, bytes.data(), bytes.size()), "close");
        }
    }
    if (failed_) return fail(ErrorCode::internal, "HDF5 refuses: {}", failed_doing_);
    return bytes;
}

}  // namespace stormcellar::netcdf
