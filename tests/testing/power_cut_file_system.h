// tests/testing/power_cut_file_system.h -- a file system that forgets what was not synced.
//
// It works on real files in a directory and remembers which contents and names were made durable.
// power_cut() then puts the directory into the worst state that a crash may leave: contents that
// were never synced become empty, and renames whose directory was not synced are undone. The file
// system can also run out of space after a number of bytes, and fail the n-th operation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {

class PowerCutFileSystem final : public FileSystem {
  public:
    Result<int> create_exclusive(const fs::path& path) override;
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override;
    Status set_size(int descriptor, std::uint64_t size) override;
    Status sync(int descriptor) override;
    void close(int descriptor) override;
    Status rename(const fs::path& from, const fs::path& to) override;
    Status sync_directory(const fs::path& directory) override;
    Status remove(const fs::path& path) override;

    // Makes the operation with this number (counted from 0) and all later operations fail with io.
    void fail_from(std::uint64_t operation) { fail_from_ = operation; }
    void set_space(std::uint64_t bytes) { space_ = bytes; }
    [[nodiscard]] std::uint64_t operation_count() const { return operations_; }
    void power_cut();

  private:
    // A rename, or (without `from`) a removal.
    struct NameChange {
        fs::path from, to;
        std::optional<fs::path> kept;  // what was at `to` before
    };
    Status count_operation();
    Result<fs::path> keep(const fs::path& path);

    std::map<int, fs::path> open_;
    std::set<fs::path> unsynced_contents_;
    std::vector<NameChange> unsynced_names_;
    TemporaryDirectory attic_;  // second names of files that may come back
    std::uint64_t kept_ = 0;
    std::uint64_t operations_ = 0;
    std::optional<std::uint64_t> fail_from_;
    std::optional<std::uint64_t> space_;
};

}  // namespace stormcellar::testing
