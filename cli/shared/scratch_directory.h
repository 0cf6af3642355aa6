// cli/shared/scratch_directory.h -- a temporary directory that does not outlive the program.
//
// The destructor removes the directory. It is also removed if SIGINT, SIGTERM, SIGHUP or SIGPIPE
// ends the program while the object exists (an ignored signal stays ignored). If an Interrupt
// (cli/shared/interrupt.h) is made later, it gets the signal first and passes it on.
//
// Threads   One object at a time.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

class ScratchDirectory {
  public:
    // Makes the directory. Errors: io if that fails.
    [[nodiscard]] static Result<ScratchDirectory> make();
    ScratchDirectory(ScratchDirectory&& other) noexcept;
    ScratchDirectory& operator=(ScratchDirectory&&) = delete;
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;
    ~ScratchDirectory();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    explicit ScratchDirectory(std::filesystem::path path);

    std::filesystem::path path_;  // empty: the object was moved from
};

}  // namespace stormcellar::cli
