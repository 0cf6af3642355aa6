// cache/grid_file.h -- one grid, one immutable file, readable by mmap with no copy.
//
// The bytes are specified in docs/cache-format.md. A file is written whole by temporary file,
// fsync and rename, and validated before anything in it is trusted: magic, version, sizes, offsets
// and the checksum of header, brick table and states at open; checksums of bricks on verify().
// Thread contract: a GridFile is immutable after open; views may be used from many threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/file_system.h"
#include "base/result.h"
#include "grid/brick_view.h"
#include "grid/grid.h"

namespace stormcellar::cache {

// All of a grid but its cells.
struct GridDescription {
    grid::GridSpec spec;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time, start_time, end_time;
    std::vector<grid::SitePosition> sites;
    grid::Provenance provenance;
};
[[nodiscard]] GridDescription describe(const grid::Grid& grid);

// Writes the file and gives its size on disk in bytes (holes not counted). io and no_space leave
// nothing behind; bad_argument for names or notes of more than 1 MiB.
[[nodiscard]] Result<std::uint64_t> write_grid_file(FileSystem& file_system,
                                                    const std::filesystem::path& path,
                                                    const GridDescription& description,
                                                    const grid::BrickView& view);

class GridFile {
  public:
    // not_found, io, truncated, corrupt (checksum, impossible sizes) or unsupported (a later
    // version); every message begins with the path.
    static Result<GridFile> open(const std::filesystem::path& path);

    GridFile(GridFile&&) noexcept;
    GridFile& operator=(GridFile&&) noexcept;
    GridFile(const GridFile&) = delete;
    GridFile& operator=(const GridFile&) = delete;
    ~GridFile();

    [[nodiscard]] const GridDescription& description() const;
    [[nodiscard]] grid::BrickView view() const;  // valid as long as this GridFile lives
    [[nodiscard]] std::uint64_t bytes_on_disk() const;
    // Reads every stored brick and compares its checksum, minimum, maximum and count.
    [[nodiscard]] Status verify() const;

  private:
    struct Mapping;
    explicit GridFile(std::unique_ptr<Mapping> mapping);
    std::unique_ptr<Mapping> mapping_;
};

}  // namespace stormcellar::cache
