// tests/catalog/power_cut_vfs.h -- SQLite on a disk that forgets what was not synced.
//
// It is a VFS on top of SQLite's own and works on real files. For each file it remembers the
// contents at the last sync, every write since, and which names were created or removed since the
// directory was last synced. power_cut() then gives the files contents that a crash may leave. A
// partial write is cut at sectors of 512 bytes; SQLite relies on no more than that (and on bytes
// beside a sector being unchanged, as its own VFS for Unix states). Directories are synced when
// SQLite's VFS for Unix syncs them: with the first sync of a new journal or WAL, and at deletions
// that ask for it.
//
// Threads   For tests of one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace stormcellar::testing {

enum class Kept { nothing, everything, some };  // what is kept of the data that was not synced

class PowerCutVfs {
  public:
    PowerCutVfs();  // becomes the default of this process
    PowerCutVfs(const PowerCutVfs&) = delete;
    PowerCutVfs& operator=(const PowerCutVfs&) = delete;
    ~PowerCutVfs();

    // The operation of this number and all later ones fail (writes, cuts, syncs, deletions and new
    // files are counted, from 0).
    void fail_from(std::uint64_t operation) { fail_from_ = operation; }
    [[nodiscard]] std::uint64_t operation_count() const { return operations_; }
    // Call it when every database is closed: puts the disk into the state after the crash. Later
    // operations succeed.
    void power_cut(Kept kept, unsigned seed);

    // For the VFS itself.
    struct Change {
        std::uint64_t offset = 0;
        std::vector<std::byte> bytes;
        std::optional<std::uint64_t> cut_to;  // set if it is a cut and not a write
    };
    struct File {
        std::vector<std::byte> synced;
        std::vector<Change> changes;  // since the last sync
        bool exists = true;           // now
        bool name_synced = true;      // whether the synced directory agrees with `exists`
    };
    bool may_go_on();  // counts an operation; false if it must fail
    File& file(const std::string& path);
    void sync_names();

  private:
    struct Vfs;
    [[nodiscard]] std::vector<std::byte> after_cut(const File& file, Kept kept,
                                                   std::minstd_rand& random) const;

    std::unique_ptr<Vfs> vfs_;
    std::map<std::string, File> files_;
    std::uint64_t operations_ = 0;
    std::optional<std::uint64_t> fail_from_;
};

}  // namespace stormcellar::testing
