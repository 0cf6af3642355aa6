// bench_compression: measures what compressing the bricks of a grid saves and costs.
//
// usage: bench_compression [--data DIR] [--runs N] [--json] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
// Each file is decoded and gridded as the daemon does by default. For its grid there is a row for
// each way of storing bricks:
//   file, codec   none (as the cache stores them), lz4, zstd 1, zstd 3
//   stored        bricks with codes, of 4,096 bytes each
//   disk_kib      size of the file on disk, with header, table and states
//   share         disk_kib as a share of that without compression
//   pack_ms       compressing all bricks, one after the other, on one thread
//   write_ms      writing and syncing the file, packing included
//   read_ms       from the name of the file to all codes in memory, on one thread: opening it and,
//                 for none, reading each stored brick through the map once, else unpacking each
//                 brick into its place
// Files are written to TMPDIR and read back from the page cache; the cost of reading from the disk
// itself is proportional to disk_kib. Times are the least of the runs.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <lz4.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zstd.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using Span = std::span<const std::byte>;

struct Codec {
    std::string name;
    std::function<Bytes(Span)> pack;
    std::function<void(Span, std::span<std::byte>)> unpack;
};

Bytes pack_zstd(Span brick, int level) {
    static thread_local ZSTD_CCtx* const context = ZSTD_createCCtx();
    Bytes packed(ZSTD_compressBound(brick.size()));
    packed.resize(ZSTD_compressCCtx(context, packed.data(), packed.size(), brick.data(),
                                    brick.size(), level));
    return packed;
}
void unpack_zstd(Span packed, std::span<std::byte> brick) {
    static thread_local ZSTD_DCtx* const context = ZSTD_createDCtx();
    const std::size_t size =
        ZSTD_decompressDCtx(context, brick.data(), brick.size(), packed.data(), packed.size());
    if (size != brick.size()) std::abort();
}
Bytes pack_lz4(Span brick) {
    const int size = static_cast<int>(brick.size());
    Bytes packed(static_cast<std::size_t>(LZ4_compressBound(size)));
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(
        reinterpret_cast<const char*>(brick.data()), reinterpret_cast<char*>(packed.data()), size,
        static_cast<int>(packed.size()))));
    return packed;
}
void unpack_lz4(Span packed, std::span<std::byte> brick) {
    const int size = LZ4_decompress_safe(
        reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(brick.data()),
        static_cast<int>(packed.size()), static_cast<int>(brick.size()));
    if (size != static_cast<int>(brick.size())) std::abort();
}

std::vector<Codec> all_codecs() {
    return {{"lz4", pack_lz4, unpack_lz4},
            {"zstd 1", [](Span brick) { return pack_zstd(brick, 1); }, unpack_zstd},
            {"zstd 3", [](Span brick) { return pack_zstd(brick, 3); }, unpack_zstd}};
}

// Returns the grid that the daemon would make of the first volume of a file; none if it would make
// none.
std::optional<grid::Grid> grid_of(const fs::path& file) {
    const auto raw = read_file(file);
    if (!raw) return std::nullopt;
    const auto decoded = level2::decode(*raw);
    if (!decoded) return std::nullopt;
    const auto antenna = level2::antenna_position(decoded->volume);
    if (!antenna) return std::nullopt;
    const grid::SitePosition site{decoded->volume.station, antenna->latitude_deg,
                                  antenna->longitude_deg, antenna->altitude_m};
    const grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    const auto geometry = grid::make_column_geometry(site, spec);
    if (!geometry) return std::nullopt;
    auto made = grid::make_grid(decoded->volume, site, **geometry, grid::GridderOptions{});
    if (!made) return std::nullopt;
    return std::move(*made);
}

// Anonymous memory as a reader would map it: zeros, touched where bricks are written.
class Places {
  public:
    explicit Places(std::size_t size)
        : size_(size),
          start_(::mmap(nullptr, size, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {
        if (start_ == MAP_FAILED) std::abort();
    }
    Places(const Places&) = delete;
    Places& operator=(const Places&) = delete;
    ~Places() { ::munmap(start_, size_); }
    [[nodiscard]] std::span<std::byte> bytes() const {
        return {static_cast<std::byte*>(start_), size_};
    }

  private:
    std::size_t size_;
    void* start_;
};

class Measurement {
  public:
    Measurement(const fs::path& file, const grid::Grid& grid, int runs)
        : name_(file.filename()),
          grid_(grid),
          bricks_(grid::BrickGrid::from(grid, grid::default_quantization(grid.moment))),
          view_(bricks_.view()),
          runs_(runs),
          path_(fs::temp_directory_path() / fmt::format("bench-compression-{}", ::getpid())) {
        for (std::size_t i = 0; i < view_.bricks.size(); ++i) {
            if (view_.bricks[i].kind == grid::BrickKind::stored) stored_.push_back(i);
        }
    }
    Measurement(const Measurement&) = delete;
    Measurement& operator=(const Measurement&) = delete;
    ~Measurement() { fs::remove(path_); }

    void plain(Table& table) {
        double write_s = HUGE_VAL, read_s = HUGE_VAL;
        for (int run = 0; run < runs_; ++run) {
            keep_least_seconds(write_s, [&] {
                const auto written = cache::write_grid_file(real_file_system(), path_,
                                                            cache::describe(grid_), view_);
                if (!written) std::abort();
                plain_bytes_ = *written;
            });
            keep_least_seconds(read_s, [&] {
                const auto file = cache::GridFile::open(path_);
                if (!file) std::abort();
                read_all(file->view());
            });
        }
        open_s_ = HUGE_VAL;
        for (int run = 0; run < runs_; ++run) {
            keep_least_seconds(open_s_, [&] {
                if (!cache::GridFile::open(path_)) std::abort();
            });
        }
        add(table, "none", plain_bytes_, 0, write_s, read_s);
    }

    // Writes the packed bricks one after the other in the place of the codes; everything before is
    // unchanged.
    void packed(const Codec& codec, Table& table) {
        const std::uint64_t metadata = plain_bytes_ - stored_.size() * brick_bytes();
        double pack_s = HUGE_VAL, write_s = HUGE_VAL, read_s = HUGE_VAL;
        std::vector<Bytes> packed;
        std::uint64_t size = 0;
        for (int run = 0; run < runs_; ++run) {
            keep_least_seconds(pack_s, [&] { packed = pack_all(codec); });
            Bytes file(metadata);
            for (const Bytes& brick : packed)
                file.insert(file.end(), brick.begin(), brick.end());
            size = (file.size() + 4095) / 4096 * 4096;
            keep_least_seconds(write_s, [&] {
                if (!write_file_atomically(real_file_system(), path_, file)) std::abort();
            });
            keep_least_seconds(read_s, [&] { unpack_all(codec, packed, metadata); });
        }
        add(table, codec.name, size, pack_s, pack_s + write_s, read_s + open_s_);
    }

  private:
    [[nodiscard]] std::size_t brick_bytes() const {
        return grid::brick_cells * static_cast<std::size_t>(view_.quantization.code_bytes);
    }
    [[nodiscard]] Span codes_of(const grid::BrickView& view, std::size_t brick) const {
        return view.codes.subspan(brick * brick_bytes(), brick_bytes());
    }
    void read_all(const grid::BrickView& view) {
        for (const std::size_t brick : stored_) {
            for (const std::byte code : codes_of(view, brick))
                sum_ = sum_ + std::to_integer<unsigned>(code);
        }
    }
    std::vector<Bytes> pack_all(const Codec& codec) {
        std::vector<Bytes> packed;
        packed.reserve(stored_.size());
        for (const std::size_t brick : stored_)
            packed.push_back(codec.pack(codes_of(view_, brick)));
        return packed;
    }
    void unpack_all(const Codec& codec, const std::vector<Bytes>& packed, std::uint64_t metadata) {
        const auto file = read_file(path_);
        if (!file) std::abort();
        const Places places(view_.codes.size());
        std::size_t at = metadata;
        for (std::size_t i = 0; i < stored_.size(); ++i) {
            codec.unpack(Span(*file).subspan(at, packed[i].size()),
                         places.bytes().subspan(stored_[i] * brick_bytes(), brick_bytes()));
            at += packed[i].size();
        }
    }
    void add(Table& table, const std::string& codec, std::uint64_t bytes, double pack_s,
             double write_s, double read_s) {
        table.add({{"file", name_},
                   {"codec", codec},
                   {"stored", static_cast<int>(stored_.size())},
                   {"disk_kib", {static_cast<double>(bytes) / 1024, 0}},
                   {"share", {static_cast<double>(bytes) / static_cast<double>(plain_bytes_), 3}},
                   {"pack_ms", {pack_s * 1e3, 2}},
                   {"write_ms", {write_s * 1e3, 2}},
                   {"read_ms", {read_s * 1e3, 2}}});
    }

    std::string name_;
    const grid::Grid& grid_;
    grid::BrickGrid bricks_;
    grid::BrickView view_;
    int runs_;
    fs::path path_;
    std::vector<std::size_t> stored_;
    std::uint64_t plain_bytes_ = 0;
    double open_s_ = 0;
    volatile unsigned sum_ = 0;
};

void measure(const fs::path& file, const Request& request, Table& table) {
    const auto grid = grid_of(file);
    if (!grid) return;
    Measurement measurement(file, *grid, request.runs);
    measurement.plain(table);
    for (const Codec& codec : all_codecs())
        measurement.packed(codec, table);
}

int run(int argc, char** argv) {
    keep_freed_memory();
    return run_over_files({"bench_compression", "[FILE ...]",
                           "what compressing the bricks of a grid saves and costs"},
                          std::span(argv, static_cast<std::size_t>(argc)), measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
