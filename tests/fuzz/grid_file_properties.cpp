// Checks the properties that must hold for a grid file of any bytes.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "cache/map_guard.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "tests/fuzz/properties.h"

namespace stormcellar::fuzz {
namespace {

using cache::GridFile;

// A file in memory that can be opened through its path.
class MemoryFile {
  public:
    MemoryFile() : number_(::memfd_create("grid", MFD_CLOEXEC)) {
        require(number_ >= 0, "no file in memory can be had");
    }
    explicit MemoryFile(std::span<const std::byte> bytes) : MemoryFile() {
        require(
            ::pwrite(number_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
            "a file in memory cannot be written");
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { ::close(number_); }

    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] std::filesystem::path path() const {
        return fmt::format("/proc/self/fd/{}", number_);
    }
    [[nodiscard]] std::vector<std::byte> bytes() const { return *read_file(path()); }
    void cut(off_t size) const { require(::ftruncate(number_, size) == 0, "it cannot be cut"); }

  private:
    int number_;
};

// Writes one file into memory, whatever its path.
class OneMemoryFile final : public FileSystem {
  public:
    Result<int> create_exclusive(const std::filesystem::path& /*path*/) override {
        return file.number();
    }
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override {
        return real_file_system().write_at(descriptor, offset, bytes);
    }
    Status set_size(int descriptor, std::uint64_t size) override {
        return real_file_system().set_size(descriptor, size);
    }
    Status sync(int /*descriptor*/) override { return {}; }
    void close(int /*descriptor*/) override {}
    Status rename(const std::filesystem::path& /*from*/,
                  const std::filesystem::path& /*to*/) override {
        return {};
    }
    Status sync_directory(const std::filesystem::path& /*directory*/) override { return {}; }
    Status remove(const std::filesystem::path& /*path*/) override { return {}; }

    MemoryFile file;
};

bool is_promised(ErrorCode code) {
    return code == ErrorCode::truncated || code == ErrorCode::corrupt ||
           code == ErrorCode::unsupported;
}

void require_named(const Error& error, const std::filesystem::path& path) {
    require(error.message.starts_with(path.native()), "'{}' does not name its file", error.message);
    require(is_promised(error.code), "code {} ({})", static_cast<int>(error.code), error.message);
}

// Requires that a stored brick has as many values as its entry says, all of them between the
// smallest and the largest code in the entry.
void require_true_entries(const grid::BrickView& view) {
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        const grid::BrickEntry& entry = view.bricks[i];
        if (entry.kind != grid::BrickKind::stored) continue;
        unsigned values = 0;
        for (std::size_t cell = 0; cell < grid::brick_cells; ++cell) {
            const std::uint16_t code = view.code_at(i * grid::brick_cells + cell);
            if (code < grid::first_value_code) continue;
            ++values;
            require(code >= entry.min_code && code <= entry.max_code, "brick {}: code {}", i, code);
        }
        require(values == entry.value_count, "brick {}: {} values", i, values);
    }
}

void require_same_cells(const grid::Grid& a, const grid::Grid& b) {
    require(a.spec == b.spec, "another spec");
    require(a.status == b.status, "other states");
    require(a.values == b.values, "other values");
}

// Requires that a grid that verify() accepts can be written and read back unchanged. Writing it
// once more must give the same bytes.
void require_writable(const GridFile& file, const grid::Grid& cells) {
    OneMemoryFile first, second;
    const auto written =
        cache::write_grid_file(first, "first.scg", file.description(), file.view(), file.packing());
    require(written.has_value(), "cannot be written again: {}",
            written ? std::string{} : written.error().message);
    const auto back = GridFile::open(first.file.path());
    require(back.has_value(), "cannot be read again: {}",
            back ? std::string{} : back.error().message);
    require(back->verify().has_value(), "fails verify() when it was written again");
    require_same_cells(grid::to_dense(back->view()), cells);
    require(cache::write_grid_file(second, "second.scg", back->description(), back->view(),
                                   back->packing())
                .has_value(),
            "cannot be written twice");
    require(first.file.bytes() == second.file.bytes(), "written twice it has other bytes");
}

}  // namespace

void check_grid_file(std::span<const std::byte> bytes) {
    cache::install_map_guard();
    const MemoryFile on_disk(bytes);
    const auto file = GridFile::open(on_disk.path());
    if (!file) return require_named(file.error(), on_disk.path());

    const grid::Grid cells = grid::to_dense(file->view());
    require(file->check_whole().has_value(), "is not whole as it is");
    if (const Status good = file->verify()) {
        require_true_entries(file->view());
        require_writable(*file, cells);
    } else {
        require_named(good.error(), on_disk.path());
    }

    on_disk.cut(4096);
    const Status cut = file->check_whole();
    require(!cut && cut.error().code == ErrorCode::truncated, "a cut file is called whole");
    (void)grid::to_dense(file->view());
    on_disk.cut(static_cast<off_t>(bytes.size()));
    // the file was all zeros after its first page, so cutting it changed nothing
    if (on_disk.bytes() == std::vector<std::byte>(bytes.begin(), bytes.end())) return;
    require(!file->verify().has_value(), "a file of which all was lost is called good");
}

}  // namespace stormcellar::fuzz
