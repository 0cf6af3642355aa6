// tests/catalog/power_cut_vfs.h -- SQLite on a disk that forgets what was not synced.
//
// A VFS over SQLite's own, which works on real files and remembers, for each, what it held when it
// was last synced, every write since, and which names were made or taken away since the directory
// was last synced. power_cut() then gives the files contents that a crash may leave. A write that
// is not whole is cut at sectors of 512 bytes; SQLite counts on no more than that (and on bytes
// beside a sector being left alone, as its own VFS for Unix says).
// Directories are synced where SQLite's VFS for Unix syncs them: with the first sync of a new
// journal or WAL, and at deletions that ask for it.
// Thread contract: for tests of one thread.
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

enum class Kept { nothing, everything, some };  // of what was not synced

class PowerCutVfs {
  public:
    PowerCutVfs();  // from now on the default of this process
    PowerCutVfs(const PowerCutVfs&) = delete;
    PowerCutVfs& operator=(const PowerCutVfs&) = delete;
    ~PowerCutVfs();

    // The operation with this number (writes, cuts, syncs, deletions and new files are counted,
    // from 0) and all later ones fail.
    void fail_from(std::uint64_t operation) { fail_from_ = operation; }
    [[nodiscard]] std::uint64_t operation_count() const { return operations_; }
    // When every database is closed: the disk as it is found after the crash. Nothing fails then.
    void power_cut(Kept kept, unsigned seed);

    // For the VFS itself.
    struct Change {
        std::uint64_t offset = 0;
        std::vector<std::byte> bytes;
        std::optional<std::uint64_t> cut_to;  // a cut, not a write
    };
    struct File {
        std::vector<std::byte> synced;
        std::vector<Change> changes;  // since then
        bool exists = true;           // now
        bool name_synced = true;      // whether the directory is known to say what `exists` says
    };
    bool may_go_on();  // counts an operation
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
