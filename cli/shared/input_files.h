// cli/shared/input_files.h -- finds and reads the raw files that a command line names.
//
// A name may be a file, a tar or zip archive (for its members), a directory (for all files below
// it, or for one volume if it holds chunks) or "-" for standard input. Chunks of one volume that
// are named one by one, as by a shell's pattern, form one volume. A member is written
// ARCHIVE!MEMBER. If an entry of a directory or an archive is not Level II, it is left out and
// reported; a named file must be Level II.
//
// Threads   One thread at a time.
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
    std::string label;           // the name in messages and results
    std::filesystem::path path;  // path of the file or its archive; empty: standard input
    std::string member;          // member of the archive; empty: the file itself
    bool was_found = false;      // found in a directory or an archive, not named directly
    // The files of a volume whose chunks are separate files, in order; empty for any other file.
    std::vector<std::filesystem::path> chunks = {};

    // Returns the last part of the path or member. It contains the station and appears in results.
    [[nodiscard]] std::string file_name() const;
};

class InputFiles {
  public:
    // Values that select from a directory with chunks of several volumes. A number from 1 selects
    // one volume, counted in order of time.
    enum OfChunks : int { newest = 0, all = -1 };
    // Finds the files. Volumes whose chunks were named one by one come first, then the other names
    // in their order. Files of a directory are sorted by path. Errors: not_found, permission and io
    // for the names; bad_argument if "-" is named twice, or if a directory has fewer volumes than
    // the selected number; not_found if no file remains.
    [[nodiscard]] static Result<InputFiles> find(std::vector<std::string> names,
                                                 int volume = newest);
    InputFiles(InputFiles&&) noexcept;
    InputFiles& operator=(InputFiles&&) noexcept;
    ~InputFiles();

    [[nodiscard]] const std::vector<InputFile>& files() const;
    [[nodiscard]] std::vector<std::string> labels() const;
    // Returns true if the file with this label was found in a directory or an archive.
    [[nodiscard]] bool is_found(const std::string& label) const;
    // Returns the entries that were left out because they cannot be read as a file, with the
    // reasons.
    [[nodiscard]] const std::vector<std::string>& left_out() const;

    // Reads a file. Members of an archive are read fastest in their order. Errors: those of
    // read_file(); corrupt if the archive no longer has the member.
    [[nodiscard]] Result<std::vector<std::byte>> read(const InputFile& file);
    // Returns the decoded file, or the decoded chunks of a directory. If the data name no station,
    // uses the station in the file's name. Sets `bytes` to the number of bytes read. Errors name
    // the file.
    [[nodiscard]] Result<level2::Decoded> decode(const InputFile& file,
                                                 level2::DecodeOptions options,
                                                 std::uint64_t* bytes = nullptr);

  private:
    struct Impl;
    explicit InputFiles(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// Prints a note for each entry that find() left out.
void note_left_out(const InputFiles& inputs);

// Returns true if the error means that a file is not a volume. If such a file was found in a
// directory or an archive, it is left out.
[[nodiscard]] bool is_no_volume(const Error& error);

}  // namespace stormcellar::cli
