// cli/shared/output_file.h -- the one file that a command writes, which may be standard output.
//
// "-" stands for standard output. The file is made in a temporary place then, for its format may
// need to go back in it, and is copied when it is whole: a reader gets all of it or nothing.
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

[[nodiscard]] bool is_stdout(std::string_view output);

// Before long work: whether the file can appear there, and whether its ending is one of these; with
// `json`, which goes to standard output too, that it is not that. `what` is made, as in "a frame is
// written as PNG". Errors: bad_argument, and those of check_target().
[[nodiscard]] Status check_output_file(const std::string& output,
                                       const std::vector<std::string_view>& endings,
                                       std::string_view what, bool json);

class OutputFile {
  public:
    // `ending`: of the temporary file, for who goes by it. Errors: those of making a temporary
    // directory.
    [[nodiscard]] static Result<OutputFile> open(const std::string& output,
                                                 std::string_view ending = {});
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    // Where to write the file.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // Once it is written. Errors: io where standard output does not take it.
    [[nodiscard]] Status finish();

  private:
    OutputFile(std::filesystem::path path, std::filesystem::path temporary)
        : path_(std::move(path)), temporary_(std::move(temporary)) {}

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // a directory of its own; empty: written in place
};

// Bytes that are in memory already. Errors: those of writing.
[[nodiscard]] Status write_output(const std::string& output, std::span<const std::byte> bytes);

}  // namespace stormcellar::cli
