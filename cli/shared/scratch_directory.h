// cli/shared/scratch_directory.h -- a temporary directory that does not outlive the program.
//
// It is removed when the object is destroyed, and also when SIGINT, SIGTERM, SIGHUP or SIGPIPE ends
// the program while the object exists (a signal that is ignored stays so). An Interrupt
// (cli/shared/interrupt.h) that is made later takes the signal first and passes it on.
//
// Threads   One object at a time.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

class ScratchDirectory {
  public:
    // Errors: io if it cannot be made.
    [[nodiscard]] static Result<ScratchDirectory> make();
    ScratchDirectory(ScratchDirectory&& other) noexcept;
    ScratchDirectory& operator=(ScratchDirectory&&) = delete;
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;
    ~ScratchDirectory();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    explicit ScratchDirectory(std::filesystem::path path);

    std::filesystem::path path_;  // empty: moved away
};

}  // namespace stormcellar::cli
