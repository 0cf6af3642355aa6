// stormcellar/cache/grid_file.h -- one grid in one immutable file, which mmap reads without a copy.
//
// docs/cache-format.md specifies the bytes. A file is written as a temporary file, synced and
// renamed. open() reads header, table, states and names into memory, and checks magic, version,
// sizes, offsets and the checksum there. Codes are mapped, or if they are packed, unpacked into
// memory and checked; verify() checks the checksums of bricks. So a file that another program
// changes later may show wrong values until verify(), but never leads a reader outside its memory.
//
// Units     Sizes are in bytes. Each open file holds one descriptor.
// Threads   A GridFile is immutable after open(). Many threads may use its views.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cache {

// The form of the bricks of codes in a file. Packed bricks take a third to three quarters of the
// space. open() unpacks them into the reader's own memory instead of mapping them.
enum class Packing { none, lz4 };

// Everything in a grid except its cells.
struct GridDescription {
    grid::GridSpec spec;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time, start_time, end_time;
    std::vector<grid::SitePosition> sites;
    grid::Provenance provenance;
};
[[nodiscard]] GridDescription describe(const grid::Grid& grid);

// Writes the file and returns its size on disk in bytes, without holes. The same cells and
// description give the same bytes. Errors: io, no_space and others of the file system; the path
// then has the old file, or the whole new file if only the sync of the directory failed.
// bad_argument for a description or view that a file cannot hold, for example with names and notes
// of more than 1 MiB, more than 4,194,304 bricks, a time outside the years 1970 to 9999, or bricks
// that do not fit the spec.
[[nodiscard]] Result<std::uint64_t> write_grid_file(FileSystem& file_system,
                                                    const std::filesystem::path& path,
                                                    const GridDescription& description,
                                                    const grid::BrickView& view,
                                                    Packing packing = Packing::none);

// Returns an upper bound of the size on disk, in bytes, of the file that write_grid_file() would
// write on a file system with blocks of `block_bytes` (a power of two). Counts each block that has
// a byte of the file and, for the file system's own lists of blocks, one block for every 64 and
// four more. Does not check the limits of write_grid_file(). The bound is too low only if a file
// system allocates blocks that nobody wrote.
[[nodiscard]] std::uint64_t most_bytes_on_disk(const GridDescription& description,
                                               const grid::BrickView& view,
                                               std::uint64_t block_bytes);

// The limits of memory for opening a file. `read_bytes` limits the bytes before the codes, and
// `unpacked_bytes` the codes of a packed file, which may take many times their size on disk. Set
// both for a file from another machine.
struct GridFileLimits {
    std::uint64_t read_bytes = ~std::uint64_t{0};
    std::uint64_t unpacked_bytes = ~std::uint64_t{0};
};
// These limits exceed the needs of any site's grid. A WSR-88D grid with cells of 500 m on 48 levels
// has 330 MB of codes if every brick is stored and the moment has two bytes a cell. A grid with
// cells of 250 m has 80 MB of table and states.
constexpr GridFileLimits limits_of_site{.read_bytes = std::uint64_t{128} << 20U,
                                        .unpacked_bytes = std::uint64_t{352} << 20U};

class GridFile {
  public:
    // Opens a file. Errors: truncated; corrupt (checksum, impossible sizes); unsupported (a later
    // version, or more than the limits allow); not_a_file; not_found, permission, io, exhausted.
    // Every message begins with the path.
    static Result<GridFile> open(const std::filesystem::path& path,
                                 const GridFileLimits& limits = {});

    GridFile(GridFile&&) noexcept;
    GridFile& operator=(GridFile&&) noexcept;
    GridFile(const GridFile&) = delete;
    GridFile& operator=(const GridFile&) = delete;
    ~GridFile();

    [[nodiscard]] const GridDescription& description() const;
    [[nodiscard]] grid::BrickView view() const;  // valid as long as this GridFile lives
    [[nodiscard]] std::uint64_t bytes_on_disk() const;
    [[nodiscard]] std::uint64_t bytes() const;  // of the file, holes included
    // Returns the checksum in the header, which covers the description and the checksums of all
    // bricks. So files with different contents have different checksums.
    [[nodiscard]] std::uint64_t checksum() const;
    // Returns another descriptor of the open file, which can be read even after the file is
    // evicted. Errors: exhausted.
    [[nodiscard]] Result<Descriptor> duplicate_descriptor() const;
    [[nodiscard]] Packing packing() const;
    // Checks, with one system call, that the size of the file has not changed since it was opened.
    // Errors: truncated or corrupt if another program cut or lengthened it. Reading mapped codes of
    // a cut file raises SIGBUS, unless the program has installed the guard of cache/map_guard.h.
    // With the guard, the codes read as 0 (not seen), and check_whole() returns truncated
    // afterward. So call check_whole() after using a view. Our own programs never cut a file.
    [[nodiscard]] Status check_whole() const;
    // Reads the whole file again, but not through the map, so that a cut file gives an error.
    // Checks that header, table and states have not changed since open(), that every stored brick
    // has its checksum, minimum, maximum and count, and that the places of absent bricks read as
    // zeros.
    [[nodiscard]] Status verify() const;

  private:
    struct Mapping;
    explicit GridFile(std::unique_ptr<Mapping> mapping);
    std::unique_ptr<Mapping> mapping_;
};

}  // namespace stormcellar::cache
