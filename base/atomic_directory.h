// base/atomic_directory.h -- a directory that gets its final name only when it is whole.
//
// The writer fills a temporary directory beside the final place, and commit() renames this
// directory. If an older directory has the final name, commit() first moves the older directory
// aside, moves it back if the new directory cannot be renamed, and removes it at the end. Without
// commit(), the destructor removes the temporary directory with all its files.
//
// Threads   One thread at a time.
// Errors    not_found, permission, no_space and io from the file system; not_a_file if the final
//           name belongs to something other than a directory; the errors of `may_replace`. Messages
//           do not name the final path.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <span>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

class AtomicDirectory {
  public:
    // Decides if a directory that has the final name may be replaced.
    using MayReplace = Status (*)(const std::filesystem::path& directory);

    // Makes the temporary directory. `final_path` has no '/' at its end.
    [[nodiscard]] static Result<AtomicDirectory> create(FileSystem& file_system,
                                                        std::filesystem::path final_path,
                                                        MayReplace may_replace);
    // Checks, before long work, that the name is free or that the directory may be replaced.
    [[nodiscard]] static Status check(const std::filesystem::path& final_path,
                                      MayReplace may_replace);
    AtomicDirectory(AtomicDirectory&& other) noexcept;
    AtomicDirectory& operator=(AtomicDirectory&&) = delete;
    AtomicDirectory(const AtomicDirectory&) = delete;
    AtomicDirectory& operator=(const AtomicDirectory&) = delete;
    ~AtomicDirectory();

    // Writes and syncs a file. `name` may have directories, which are made.
    Status write(const std::filesystem::path& name, std::span<const std::byte> bytes);
    // Syncs the directories, gives the outermost directory its final name, and syncs the directory
    // around it.
    Status commit();

  private:
    AtomicDirectory(FileSystem& file_system, std::filesystem::path final_path,
                    std::filesystem::path temporary_path, MayReplace may_replace);

    FileSystem* file_system_;
    std::filesystem::path final_path_;
    std::filesystem::path temporary_path_;  // empty after commit(), or in an object moved from
    MayReplace may_replace_;
    std::set<std::filesystem::path> directories_;  // all that write() made, and the outermost
};

}  // namespace stormcellar
