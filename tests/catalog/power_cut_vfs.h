// tests/catalog/power_cut_vfs.h -- lets SQLite work on a disk that loses data that were not synced.
//
// PowerCutVfs is a VFS on top of SQLite's own, and works on real files. For each file it remembers
// the contents at the last sync, every write since then, and the names that were created or removed
// since the last sync of the directory. power_cut() then gives the files contents that a crash may
// leave. A partial write ends at a sector of 512 bytes and leaves the bytes beside it unchanged;
// SQLite relies on no more than that. Directories are synced when SQLite's VFS for Unix syncs them:
// with the first sync of a new journal or WAL, and at deletions that ask for it.
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

enum class Kept { nothing, everything, some };  // how much of the unsynced data a power cut keeps

class PowerCutVfs {
  public:
    PowerCutVfs();  // makes this VFS the default in this process
    PowerCutVfs(const PowerCutVfs&) = delete;
    PowerCutVfs& operator=(const PowerCutVfs&) = delete;
    ~PowerCutVfs();

    // Makes the operation with this number fail, and all later operations. Writes, cuts, syncs,
    // deletions and new files are counted, from 0.
    void fail_from(std::uint64_t operation) { fail_from_ = operation; }
    [[nodiscard]] std::uint64_t operation_count() const { return operations_; }
    // Puts the disk into a state after a crash. Call it when every database is closed. Later
    // operations succeed.
    void power_cut(Kept kept, unsigned seed);

    // The VFS itself uses the following.
    struct Change {
        std::uint64_t offset = 0;
        std::vector<std::byte> bytes;
        std::optional<std::uint64_t> cut_to;  // set for a cut; none for a write
    };
    struct File {
        std::vector<std::byte> synced;
        std::vector<Change> changes;  // since the last sync
        bool exists = true;           // now
        bool name_synced = true;      // the synced directory agrees with `exists`
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
