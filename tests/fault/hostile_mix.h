// tests/fault/hostile_mix.h -- a malicious writer: every kind of attack at once, chosen by a seed.
//
// It writes into a drop directory at a given rate, beside honest writers, below directories of its
// own and below those of the stations. Its files claim invented or known stations, including the
// real ones of the feed, at times that no real volume has. It never touches the files and
// directories of the honest writers, because no daemon could repair that. Only a limited number of
// its files exist at a time; the oldest are removed first, and remove_all() removes everything. The
// bytes are made in advance, so that writing costs little.
//
// Threads   begin() and end() from one thread; one thread writes between them.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/fault/hostile_files.h"

namespace stormcellar::fault {

enum class Attack : std::uint8_t {
    invented,   // a volume of an unknown station, with or without a position
    known,      // a small volume that claims a known station
    endless,    // a file whose sweep never ends, of 5 or 50 MB unpacked, or an unfinished record
    growth,     // some more bytes for one of these
    unsettled,  // a file that cannot be gridded, has no end, or has no meaning
    chunk,      // one of hundreds of volumes whose chunks come in turn, without end
    rename,     // of a file or a directory, and back
    link,       // symbolic, out, dangling, in loops
    special,    // a FIFO or a socket
    sparse,     // GiB to TiB of holes
    name,       // newlines, escapes, 255 bytes, names of other stations
    clock,      // files of the past and the future, volumes of 1970 and 2049
    bomb,       // a file that unpacks to far more
    deleted,    // deleted right after it appeared
};
inline constexpr std::size_t attack_count = 14;
[[nodiscard]] std::string_view name_of(Attack attack);

struct MixOptions {
    std::filesystem::path drop;
    std::filesystem::path outside;  // where links lead
    double rate = 1000;             // files a second
    std::uint32_t seed = 1;
    std::size_t most_standing = 50'000;
};

class HostileMix {
  public:
    explicit HostileMix(MixOptions options);
    HostileMix(const HostileMix&) = delete;
    HostileMix& operator=(const HostileMix&) = delete;
    ~HostileMix();

    void begin();
    // Stops writing; all files stay.
    void end();
    void remove_all();

    // Returns how much was done of each kind. Call it after end().
    [[nodiscard]] const std::array<std::uint64_t, attack_count>& done() const { return done_; }
    [[nodiscard]] std::uint64_t all_done() const;
    [[nodiscard]] double seconds() const { return seconds_; }

  private:
    // Directories are renamed meanwhile, so a file in one of `directories_` refers to it by index.
    struct Standing {
        std::filesystem::path path;  // absolute, or below the directory
        std::optional<std::size_t> directory;
    };
    struct Volume {
        std::filesystem::path directory;
        std::string name;  // "20220317-000842"
        std::size_t station = 0;
        int next = 1;
    };
    void make_bytes();
    void run();
    void strike();
    void strike(Attack attack);
    std::string some_station();
    // Returns where the next file goes, and its name.
    Standing place(std::string_view stem);
    [[nodiscard]] std::filesystem::path path_of(const Standing& file) const;
    void write(const Standing& file, const Bytes& bytes);
    void strike_known();
    void strike_endless();
    void strike_growth();
    void strike_unsettled();
    void strike_chunk();
    void strike_rename();
    void strike_link();
    void strike_special();
    void strike_sparse();
    void strike_name();
    void strike_clock();
    void strike_deleted();
    void make_room();
    std::size_t below(std::size_t count) { return random_() % count; }
    const Bytes& one_of(const std::vector<Bytes>& pool) { return pool[below(pool.size())]; }

    MixOptions options_;
    std::mt19937 random_;
    std::vector<Bytes> invented_, unsettled_, records_, headers_, endless_small_, endless_large_,
        clocks_, bombs_, small_bombs_;
    std::vector<std::vector<Bytes>> known_;  // by station
    std::vector<std::string> known_names_;
    std::vector<std::filesystem::path> directories_;
    std::vector<Volume> volumes_;
    std::vector<Standing> growing_;
    std::deque<Standing> standing_;
    std::uint64_t number_ = 0;
    std::array<std::uint64_t, attack_count> done_{};
    double seconds_ = 0;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace stormcellar::fault
