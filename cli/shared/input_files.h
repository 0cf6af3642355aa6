// cli/shared/input_files.h -- the raw files that a command line names.
//
// A name may stand for one file, for a tar or zip archive (its members), for a directory (the files
// in it and below it, or one volume where it holds that volume's chunks) or, as "-", for standard
// input. Names of members are written ARCHIVE!MEMBER. What a directory or an archive holds beside
// Level II is left out and named; a file that is named itself has to be Level II.
// Thread contract: one thread at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {

struct InputFile {
    std::string label;           // as messages and results name it
    std::filesystem::path path;  // of the file, or of its archive; empty: standard input
    std::string member;          // of the archive; empty: the file itself
    bool was_found = false;      // in a directory or an archive, and not named itself

    // The last part of its name: what tells of its station, and stands in results.
    [[nodiscard]] std::string file_name() const;
};

class InputFiles {
  public:
    // In the order of the names; files of a directory by their paths. Errors: not_found, permission
    // and io of what was named; bad_argument where "-" is named twice; not_found where nothing is
    // left.
    [[nodiscard]] static Result<InputFiles> find(const std::vector<std::string>& names);
    InputFiles(InputFiles&&) noexcept;
    InputFiles& operator=(InputFiles&&) noexcept;
    ~InputFiles();

    [[nodiscard]] const std::vector<InputFile>& files() const;
    [[nodiscard]] std::vector<std::string> labels() const;
    // Whether the file of this label was found, and not named itself.
    [[nodiscard]] bool is_found(const std::string& label) const;
    // What was found and is no file to read, with the reason.
    [[nodiscard]] const std::vector<std::string>& left_out() const;

    // Members are fastest in their order. Errors: those of read_file(); corrupt where the archive
    // does not have the member any more.
    [[nodiscard]] Result<std::vector<std::byte>> read(const InputFile& file);
    // The whole file, or the chunks of a directory, decoded; the station is that of its name where
    // the file has none. `bytes`: how many were read. Errors name the file.
    [[nodiscard]] Result<level2::Decoded> decode(const InputFile& file,
                                                 level2::DecodeOptions options,
                                                 std::uint64_t* bytes = nullptr);

  private:
    struct Impl;
    explicit InputFiles(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// Whether a file that was only found, and not named, is left out for this error: it is no volume.
[[nodiscard]] bool is_no_volume(const Error& error);

}  // namespace stormcellar::cli
