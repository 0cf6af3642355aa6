// tests/fault/hostile_mix.h -- a malicious writer that mixes attacks of every kind. A seed decides
// the mixture.
//
// The attacker writes into a drop directory at a given rate, beside honest writers, below its own
// directories and below the directories of stations. Its files claim invented or known stations,
// including the stations of the real feed, at times that no real volume has. The attacker never
// touches the files and directories of the honest writers, because no daemon could repair that.
// Only a limited number of its files exist at a time; the oldest are removed first, and
// remove_all() removes everything. The bytes are made in advance, so that writing costs little.
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
    growth,     // further bytes for an endless file
    unsettled,  // a file that cannot be gridded, has no end, or has no meaning
    chunk,      // a chunk of one of hundreds of volumes, which take turns without end
    rename,     // a file is renamed, or a directory is renamed and renamed back
    link,       // a symbolic link that leads out, dangles or loops
    special,    // a FIFO or a socket
    sparse,     // a file of GiB to TiB of holes
    name,       // a name with newlines, escapes, 255 bytes or another station
    clock,      // a file of the past or the future, or a volume of 1970 or 2049
    bomb,       // a small file that unpacks to a huge one
    deleted,    // a file that is deleted right after it appears
};
inline constexpr std::size_t attack_count = 14;
[[nodiscard]] std::string_view name_of(Attack attack);

struct MixOptions {
    std::filesystem::path drop;
    std::filesystem::path outside;  // the target of links
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
    // Stops writing, and keeps all files.
    void end();
    void remove_all();

    // Returns the number of attacks of each kind. Call it after end().
    [[nodiscard]] const std::array<std::uint64_t, attack_count>& done() const { return done_; }
    [[nodiscard]] std::uint64_t all_done() const;
    [[nodiscard]] double seconds() const { return seconds_; }

  private:
    // A file in one of `directories_` refers to the directory by index, because attacks rename
    // directories.
    struct Standing {
        std::filesystem::path path;  // absolute, or relative to the directory
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
    // Returns the directory and the name of the next file.
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
