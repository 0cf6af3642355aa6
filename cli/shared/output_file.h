// cli/shared/output_file.h -- the one file that a command writes, or standard output.
//
// "-" means standard output. The output is then written to a temporary file, because its format may
// need to seek. The complete file is copied to standard output, so that a reader gets all of it or
// nothing. If a signal ends the program, the temporary file is removed.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/shared/scratch_directory.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

[[nodiscard]] bool is_stdout(std::string_view output);

// Checks, before the long work begins, that the file can be written and has one of these endings.
// With `json`, which uses standard output, the file must not be standard output. `what` describes
// the output, as in "a grid is netCDF". Errors: bad_argument, and those of check_target().
[[nodiscard]] Status check_output_file(const std::string& output,
                                       const std::vector<std::string_view>& endings,
                                       std::string_view what, bool json);

class OutputFile {
  public:
    // `ending` is the ending of the temporary file, for writers that depend on it. Errors: those of
    // making a temporary directory.
    [[nodiscard]] static Result<OutputFile> open(const std::string& output,
                                                 std::string_view ending = {});

    // The path to which the caller must write.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // Copies a temporary file to standard output. Call finish() when the file is complete. Errors:
    // io if standard output does not accept it.
    [[nodiscard]] Status finish();

  private:
    OutputFile(std::filesystem::path path, std::optional<ScratchDirectory> scratch)
        : path_(std::move(path)), scratch_(std::move(scratch)) {}

    std::filesystem::path path_;
    std::optional<ScratchDirectory> scratch_;  // none: the output is written in place
};

// Writes bytes that are already in memory. Errors: those of writing.
[[nodiscard]] Status write_output(const std::string& output, std::span<const std::byte> bytes);

}  // namespace stormcellar::cli
