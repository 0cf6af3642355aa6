// stormcellar/cache/grid_file.h -- one grid, one immutable file, readable by mmap with no copy.
//
// The bytes are specified in docs/cache-format.md. A file is written whole by temporary file,
// fsync and rename, and validated before anything in it is trusted: magic, version, sizes, offsets
// and the checksum of header, brick table and states at open; checksums of bricks on verify().
// Header, table, states and names are read into memory and checked there; only the codes are
// mapped, or, where they are packed, unpacked into memory and checked, too. So a file that another
// program alters later may show wrong values until verify(), but never leads a reader outside its
// memory. Each open file holds one descriptor. Thread contract: a GridFile is immutable after open;
// views may be used from many threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cache {

// How bricks of codes stand in a file. Packed ones take a third to three quarters of the space, are
// unpacked into memory of the reader's own when the file is opened, and need no map.
enum class Packing { none, lz4 };

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
// nothing behind (where only the directory's sync failed, the new file stands, whole);
// bad_argument for names or notes of more than 1 MiB, more than 4,194,304 bricks, a time beyond
// the years 1970 to 9999, or a view that does not fit its spec. The same cells and description
// give the same bytes.
[[nodiscard]] Result<std::uint64_t> write_grid_file(FileSystem& file_system,
                                                    const std::filesystem::path& path,
                                                    const GridDescription& description,
                                                    const grid::BrickView& view,
                                                    Packing packing = Packing::none);

// What that file may take on disk at most, in bytes, on a file system that allocates blocks of
// `block_bytes` (a power of two): each block that a byte falls into, and room for the lists of
// blocks that the file system itself keeps (1 in 64, and 4). Bounds such as those of
// write_grid_file are not checked. Too low only where a file system allocates what nobody wrote.
[[nodiscard]] std::uint64_t most_bytes_on_disk(const GridDescription& description,
                                               const grid::BrickView& view,
                                               std::uint64_t block_bytes);

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
    [[nodiscard]] Packing packing() const;
    // Whether the file still has the size that it had when it was opened: truncated or corrupt when
    // another program cut or lengthened it. One system call. Codes of a file that is cut before
    // their use raise SIGBUS, as with any map, unless the program has the guard of
    // cache/map_guard.h: then they read as 0 (not seen), and this says truncated afterwards. So ask
    // after a view was used, too. Nothing of ours ever cuts a file.
    [[nodiscard]] Status check_whole() const;
    // Reads the whole file again (not through the map, so a cut file is an error here): header,
    // table and states are as they were opened; every stored brick has its checksum, minimum,
    // maximum and count; the places of absent bricks read as zeros.
    [[nodiscard]] Status verify() const;

  private:
    struct Mapping;
    explicit GridFile(std::unique_ptr<Mapping> mapping);
    std::unique_ptr<Mapping> mapping_;
};

}  // namespace stormcellar::cache
